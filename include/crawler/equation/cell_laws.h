// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>
#include <crawler/equation/crawler_equation.h>
#include <crawler/equation/point_laws.h>

#include <cstddef>

/// Laws for the loops of cell_loops.h.
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Laws of plain bodies and grounds: N = m + k e, f = g(w) v. @p friction(w, g) writes g at the points, (w, g, w_dg)
  /// also its derivative by log w.
  template <int n, typename Number, typename Friction>
  struct PlainLaws
  {
    static constexpr bool has_one_modulus = true;
    Number k;
    const Number *m; ///< active stress at the points
    Friction friction;

    static constexpr bool
    has_place()
    {
      return false;
    }
    static constexpr bool
    has_rate()
    {
      return false;
    }

    void
    forces(const Number *e, const Number *w, const Number *v, Number *N, Number *f) const
    {
      for (int p = 0; p < n; ++p)
        N[p] = equation::body_force(e[p], m[p], k);
      if (v == nullptr)
        return;
      friction(w, f);
      for (int p = 0; p < n; ++p)
        f[p] = equation::friction_force(f[p], v[p]);
    }

    template <bool by_state>
    void
    derivatives(const Number *, const Number *w, const Number *v, PointDerivatives<n, Number> &D) const
    {
      if constexpr (!by_state)
        return friction(w, D.f_v);
      friction(w, D.f_v, D.f_w);
      for (int p = 0; p < n; ++p)
        D.f_w[p] = D.f_w[p] / w[p] * v[p];
    }

    void
    densities(const Number *e, const Number *w, const Number *v, const Number *v_s, PointDensities<Number> *at) const
    {
      Number g[n];
      friction(w, g);
      for (int p = 0; p < n; ++p)
        at[p] = {equation::elastic_energy(e[p], k),
                 equation::stress_power(m[p], v_s[p]),
                 equation::friction_force(g[p], v[p])};
    }
  };

  /// Laws of general bodies and grounds whose values at the points are known.
  template <int n, typename Number>
  struct KnownLaws
  {
    static constexpr bool has_one_modulus = false;
    const PointLaws<Number> &all;
    std::size_t first; ///< first point of the cell

    bool
    has_place() const
    {
      return all.f_u != nullptr;
    }
    bool
    has_rate() const
    {
      return all.N_rate != nullptr;
    }

    void
    forces(const Number *, const Number *, const Number *, Number *N, Number *f) const
    {
      for (int p = 0; p < n; ++p)
      {
        N[p] = all.N[first + p];
        f[p] = all.f[first + p];
      }
    }
    template <bool>
    void
    derivatives(const Number *, const Number *w, const Number *, PointDerivatives<n, Number> &D) const
    {
      for (int p = 0; p < n; ++p)
      {
        D.f_v[p]    = all.f_v[first + p];
        D.f_w[p]    = all.w_f_w[first + p] / w[p];
        D.N_w[p]    = all.N_w[first + p];
        D.f_u[p]    = has_place() ? all.f_u[first + p] : Number{};
        D.N_rate[p] = has_rate() ? all.N_rate[first + p] : Number{};
      }
    }
    void
    densities(const Number *e, const Number *, const Number *, const Number *v_s, PointDensities<Number> *at) const
    {
      for (int p = 0; p < n; ++p)
        at[p] = {equation::elastic_energy(e[p], all.k[first + p]),
                 equation::stress_power(all.m[first + p], v_s[p]),
                 all.f[first + p]};
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
