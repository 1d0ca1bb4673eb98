// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>
#include <crawler/equation/crawler_equation.h>

/**
 * The integrals over one cell in the position form, for one body (Number is double) or for several side by side
 * (Number is a pack of them). Included by what compiles them; users want cell_kernels.h.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Tables of a ReferenceElement.
  struct ElementTables
  {
    const double *values;      ///< [n points][n nodes] shape functions
    const double *derivatives; ///< [n points][n nodes]
    const double *weights;     ///< [n points]
    const double *stiffness;   ///< [n nodes][n nodes]
  };

  /// at_points = offset + factor * table nodal.
  template <int n, typename Number>
  inline void
  evaluate(const double *table, const Number *nodal, const double factor, const double offset, Number *at_points)
  {
    for (int p = 0; p < n; ++p)
    {
      Number sum = table[p * n] * nodal[0];
      for (int i = 1; i < n; ++i)
        sum += table[p * n + i] * nodal[i];
      at_points[p] = offset + factor * sum;
    }
  }

  /**
   * Adds int N phi_i,s, and if there is a velocity @p v int g v phi_i, to @p f. @p friction(w, g) writes the friction
   * at all points; the stretches are left in @p w.
   */
  template <int n, typename Number, typename Friction>
  inline void
  cell_residual(const ElementTables &tables,
                const double h,
                const Number &k,
                const Number *u,
                const Number *v,
                const Number *m,
                const Friction &friction,
                Number *w,
                Number *f)
  {
    Number e[n], force[n];
    evaluate<n>(tables.derivatives, u, 1. / h, 0., e);
    for (int p = 0; p < n; ++p)
    {
      w[p]     = 1. + e[p];
      force[p] = tables.weights[p] * equation::body_force(e[p], m[p], k);
    }
    if (v != nullptr)
    {
      Number g[n], v_at[n];
      friction(w, g);
      evaluate<n>(tables.values, v, 1., 0., v_at);
      for (int p = 0; p < n; ++p)
        g[p] = h * tables.weights[p] * equation::friction_force(g[p], v_at[p]);
      for (int p = 0; p < n; ++p)
        for (int i = 0; i < n; ++i)
          f[i] += g[p] * tables.values[p * n + i] + force[p] * tables.derivatives[p * n + i];
    }
    else
      for (int p = 0; p < n; ++p)
        for (int i = 0; i < n; ++i)
          f[i] += force[p] * tables.derivatives[p * n + i];
  }

  /// dF/du (@p K) and dF/dv (@p M). @p friction(w, g, w_dg) writes g and its derivative by log w.
  template <int n, typename Number, typename Friction>
  inline void
  cell_jacobians(const ElementTables &tables,
                 const double h,
                 const Number &k,
                 const Number *u,
                 const Number *v,
                 const Friction &friction,
                 Number *K,
                 Number *M)
  {
    Number w[n], g[n], dg[n], v_at[n];
    evaluate<n>(tables.derivatives, u, 1. / h, 1., w);
    evaluate<n>(tables.values, v, 1., 0., v_at);
    friction(w, g, dg);
    for (int p = 0; p < n; ++p)
    {
      dg[p] = tables.weights[p] * dg[p] / w[p] * v_at[p]; // h * (1/h)
      g[p]  = h * tables.weights[p] * g[p];
    }
    for (int i = 0; i < n; ++i)
    {
      Number row_K[n], row_M[n];
      for (int j = 0; j < n; ++j)
      {
        row_K[j] = k * (1. / h) * tables.stiffness[i * n + j];
        row_M[j] = Number{};
      }
      for (int p = 0; p < n; ++p)
      {
        const Number from_w = tables.values[p * n + i] * dg[p], from_v = tables.values[p * n + i] * g[p];
        for (int j = 0; j < n; ++j)
        {
          row_K[j] += from_w * tables.derivatives[p * n + j];
          row_M[j] += from_v * tables.values[p * n + j];
        }
      }
      for (int j = 0; j < n; ++j)
      {
        K[i * n + j] = row_K[j];
        M[i * n + j] = row_M[j];
      }
    }
  }

  /// M alone.
  template <int n, typename Number, typename Friction>
  inline void
  cell_mass(const ElementTables &tables, const double h, const Number *u, const Friction &friction, Number *M)
  {
    Number w[n], g[n];
    evaluate<n>(tables.derivatives, u, 1. / h, 1., w);
    friction(w, g);
    for (int i = 0; i < n; ++i)
    {
      Number row[n];
      for (int j = 0; j < n; ++j)
        row[j] = Number{};
      for (int p = 0; p < n; ++p)
      {
        const Number factor = h * tables.weights[p] * tables.values[p * n + i] * g[p];
        for (int j = 0; j < n; ++j)
          row[j] += factor * tables.values[p * n + j];
      }
      for (int j = 0; j < n; ++j)
        M[i * n + j] = row[j];
    }
  }

  /// Adds the integrals of a cell to @p sum, which has the members of CellIntegrals (cell_kernels.h).
  template <int n, typename Number, typename Friction, typename Sums>
  inline void
  cell_integrals(const ElementTables &tables,
                 const double h,
                 const Number &k,
                 const Number *u,
                 const Number *v,
                 const Number *m,
                 const Friction &friction,
                 Sums &sum)
  {
    Number e[n], w[n], g[n], u_at[n], v_at[n], v_s[n];
    evaluate<n>(tables.derivatives, u, 1. / h, 0., e);
    for (int p = 0; p < n; ++p)
      w[p] = 1. + e[p];
    evaluate<n>(tables.values, u, 1., 0., u_at);
    evaluate<n>(tables.values, v, 1., 0., v_at);
    evaluate<n>(tables.derivatives, v, 1. / h, 0., v_s);
    friction(w, g);
    for (int p = 0; p < n; ++p)
    {
      const double ds    = h * tables.weights[p];
      const Number power = equation::stress_power(m[p], v_s[p]), force = equation::friction_force(g[p], v_at[p]);
      sum.displacement += ds * u_at[p];
      sum.velocity += ds * v_at[p];
      sum.elastic_energy += ds * equation::elastic_energy(e[p], k);
      sum.stress_power += ds * power;
      sum.positive_power += ds * (power > 0. ? power : Number{});
      sum.absolute_power += ds * (power > 0. ? power : -power);
      sum.dissipation += ds * equation::dissipation(g[p], v_at[p]);
      sum.net_friction += ds * force;
      sum.abs_friction += ds * (force > 0. ? force : -force);
    }
  }
} // namespace crawler::CRAWLER_INSTRUCTION_SET
