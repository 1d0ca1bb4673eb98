// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>
#include <crawler/equation/point_laws.h>
#include <crawler/mesh/element_tables.h>

/**
 * Integrals over one cell in the position form, for one body (Number is double) or for several side by side (Number is
 * a pack of them), with any laws (point_laws.h). Included by the files that compile them; users want cell_kernels.h.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Interpolation to the points: at_points = offset + factor * table nodal.
  template <int n, typename Number, typename Factor>
  inline void
  evaluate(const double *table, const Number *nodal, const Factor &factor, const double offset, Number *at_points)
  {
    for (int p = 0; p < n; ++p)
    {
      Number sum = table[p * n] * nodal[0];
      for (int i = 1; i < n; ++i)
        sum += table[p * n + i] * nodal[i];
      at_points[p] = offset + factor * sum;
    }
  }

  /// Strain, stretch and velocity at the points of a cell.
  template <int n, typename Number>
  struct StateAtPoints
  {
    Number e[n], w[n], v[n];

    /// @p v at the nodes; null: the body is at rest.
    template <typename Size>
    [[gnu::always_inline]] StateAtPoints(const ElementTables &tables, const Size &h, const Number *u, const Number *v)
    {
      evaluate<n>(tables.derivatives, u, 1. / h, 0., e);
      for (int p = 0; p < n; ++p)
        w[p] = 1. + e[p];
      if (v != nullptr)
        evaluate<n>(tables.values, v, 1., 0., this->v);
      else
        for (int p = 0; p < n; ++p)
          this->v[p] = Number{};
    }
  };

  /// Adds int N phi_i,s, and int f phi_i unless @p f is null, to the nodes from @p first to before @p end.
  template <int n, typename Number, typename Size>
  [[gnu::always_inline]] inline void
  add_forces(const ElementTables &tables,
             const Size &h,
             const Number *N,
             const Number *f,
             Number *F,
             const int first = 0,
             const int end   = n)
  {
    Number force[n], friction[n];
    for (int p = 0; p < n; ++p)
      force[p] = tables.weights[p] * N[p];
    if (f != nullptr)
    {
      for (int p = 0; p < n; ++p)
        friction[p] = h * tables.weights[p] * f[p];
      for (int p = 0; p < n; ++p)
        for (int i = first; i < end; ++i)
          F[i] += friction[p] * tables.values[p * n + i] + force[p] * tables.derivatives[p * n + i];
    }
    else
      for (int p = 0; p < n; ++p)
        for (int i = first; i < end; ++i)
          F[i] += force[p] * tables.derivatives[p * n + i];
  }

  /// Force in the body @p N and, unless @p v is null, the friction @p f at the points of a cell; returns the state.
  template <int n, typename Number, typename Size, typename Laws>
  [[gnu::always_inline]] inline StateAtPoints<n, Number>
  cell_forces(const ElementTables &tables,
              const Size &h,
              const Laws &laws,
              const Number *u,
              const Number *v,
              Number *N,
              Number *f)
  {
    const StateAtPoints<n, Number> at(tables, h, u, v);
    laws.forces(at.e, at.w, v != nullptr ? at.v : nullptr, N, f);
    return at;
  }

  /// Derivatives at the points of a cell.
  template <int n, bool by_state, typename Number, typename Size, typename Laws>
  inline PointDerivatives<n, Number>
  cell_derivatives(const ElementTables &tables, const Size &h, const Laws &laws, const Number *u, const Number *v)
  {
    const StateAtPoints<n, Number> at(tables, h, u, v);
    PointDerivatives<n, Number> D;
    laws.template derivatives<by_state>(at.e, at.w, at.v, D);
    return D;
  }

  /// Derivatives dF/du (@p K, unless not by_state) and dF/dv (@p M) of a cell, dense blocks.
  template <int n, bool by_state, typename Number, typename Size, typename Laws>
  inline void
  cell_blocks(const ElementTables &tables,
              const Size &h,
              const Laws &laws,
              const Number *u,
              const Number *v,
              Number *K,
              Number *M)
  {
    auto D = cell_derivatives<n, by_state, Number>(tables, h, laws, u, v);
    for (int p = 0; p < n; ++p)
    {
      const Size ds = h * tables.weights[p], d_by_s = tables.weights[p] * (1. / h);
      D.f_v[p] = ds * D.f_v[p];
      if constexpr (by_state)
        D.f_w[p] = tables.weights[p] * D.f_w[p]; // h * (1/h)
      if (laws.has_place())
        D.f_u[p] = ds * D.f_u[p];
      if constexpr (!Laws::has_one_modulus)
        D.N_w[p] = d_by_s * D.N_w[p];
      if (laws.has_rate())
        D.N_rate[p] = d_by_s * D.N_rate[p];
    }
    const auto add = [](const Number &factor, const double *trial, Number *row) {
      for (int j = 0; j < n; ++j)
        row[j] += factor * trial[j];
    };
    for (int i = 0; i < n; ++i)
    {
      Number row_K[n], row_M[n];
      for (int j = 0; j < n; ++j)
      {
        row_M[j] = Number{};
        if constexpr (Laws::has_one_modulus)
          row_K[j] = laws.k * (1. / h) * tables.stiffness[i * n + j];
        else
          row_K[j] = Number{};
      }
      for (int p = 0; p < n; ++p)
      {
        const double *phi = tables.values + p * n, *phi_s = tables.derivatives + p * n;
        if constexpr (by_state)
        {
          add(phi[i] * D.f_w[p], phi_s, row_K);
          if (laws.has_place())
            add(phi[i] * D.f_u[p], phi, row_K);
          if constexpr (!Laws::has_one_modulus)
            add(phi_s[i] * D.N_w[p], phi_s, row_K);
        }
        add(phi[i] * D.f_v[p], phi, row_M);
        if (laws.has_rate())
          add(phi_s[i] * D.N_rate[p], phi_s, row_M);
      }
      for (int j = 0; j < n; ++j)
      {
        if constexpr (by_state)
          K[i * n + j] = row_K[j];
        M[i * n + j] = row_M[j];
      }
    }
  }

  /// Adds the contribution of a point with the weight @p ds and the velocity @p v to @p sum, which has the members of
  /// CellIntegrals (cell_kernels.h).
  template <typename Number, typename Sums>
  inline void
  add_densities(const double ds, const PointDensities<Number> &at, const Number &v, Sums &sum)
  {
    const Number power = at.power, force = at.force;
    sum.velocity += ds * v;
    sum.elastic_energy += ds * at.elastic_energy;
    sum.stress_power += ds * power;
    sum.positive_power += ds * (power > 0. ? power : Number{});
    sum.absolute_power += ds * (power > 0. ? power : -power);
    sum.dissipation += ds * (force * v);
    sum.net_friction += ds * force;
    sum.abs_friction += ds * (force > 0. ? force : -force);
  }

  /// Displacement, velocity and densities at the points of a cell.
  template <int n, typename Number>
  struct CellDensities
  {
    Number u[n], v[n];
    PointDensities<Number> at[n];

    template <typename Size, typename Laws>
    [[gnu::always_inline]] CellDensities(
      const ElementTables &tables, const Size &h, const Laws &laws, const Number *u, const Number *v)
    {
      const StateAtPoints<n, Number> state(tables, h, u, v);
      Number v_s[n];
      evaluate<n>(tables.values, u, 1., 0., this->u);
      evaluate<n>(tables.derivatives, v, 1. / h, 0., v_s);
      laws.densities(state.e, state.w, state.v, v_s, at);
      for (int p = 0; p < n; ++p)
        this->v[p] = state.v[p];
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
