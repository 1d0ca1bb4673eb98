// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/cell_laws.h>
#include <crawler/equation/cell_loops.h>
#include <crawler/lanes/lane_mesh.h>
#include <crawler/lanes/one_cell.h>

/// Loops over all cells of one degree q (included by lane_blocks.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// @p Group: the cells that are computed together, OneCell or CellGroup. Sums have the order of one cell after the
  /// other, so that results are the same but for round-off of fused products.
  template <typename Group, int q>
  struct LaneKernels
  {
    static constexpr int n = q + 1, width = Group::width;
    using Number = typename Group::Number;
    using Value  = typename Group::Value;
    /// Elements of an array that belong to a group.
    using Elements = typename Group::template Elements<n>;

    /// Friction at the points of a cell.
    struct CellFriction
    {
      const LaneFriction<Value> &law;

      void
      operator()(const Value *w, Value *g, Value *w_dg = nullptr) const
      {
        law(w, g, n);
        for (int p = 0; p < n && w_dg != nullptr; ++p)
          w_dg[p] = law.a * g[p];
      }
    };

    using Laws = PlainLaws<n, Value, CellFriction>;

    /// Calls @p use(laws, sizes, group) for each group; the laws of general bodies have what is @p wanted.
    template <unsigned int wanted, typename Use>
    [[gnu::always_inline]] static inline void
    for_cells(const LaneMesh<Number> &mesh, const Number *m, const Use &use)
    {
      if (mesh.laws != nullptr)
        for (int c = 0; c < mesh.n_cells; c += width)
        {
          const Group group(c, mesh.n_cells);
          const typename Group::template Laws<n, wanted> own(*mesh.laws, group);
          use(KnownLaws<n, Value>{own.laws, own.first}, group.load(mesh.sizes, 1, 0), group);
        }
      else
      {
        const auto &friction = Group::in_all_lanes(mesh.friction);
        for (int c = 0; c < mesh.n_cells; c += width)
        {
          const Group group(c, mesh.n_cells);
          const Elements stress(group, m, n);
          use(Laws{Group::in_all_lanes(mesh.k), stress.begin, {friction}}, group.load(mesh.sizes, 1, 0), group);
        }
      }
    }

    /// States for the laws of general bodies, at all points.
    [[gnu::flatten]] static void
    states(const LaneMesh<Number> &mesh, const Number *u, const Number *v, const LaneStateAtPoints<Number> &at)
    {
      for (int c = 0; c < mesh.n_cells; c += width)
      {
        const Group group(c, mesh.n_cells);
        const Elements own_u(group, u, q), own_v(group, v, q);
        const auto inverse_size = 1. / group.load(mesh.sizes, 1, 0);
        const auto write        = [&](const double *table, const Elements &nodal, const auto &factor, Number *values) {
          typename Group::template Nodes<Number, n> here(group, values);
          evaluate<n>(table, nodal.begin, factor, 0., here.values);
          here.store(0, n);
        };
        write(mesh.tables.values, own_u, 1., at.u);
        write(mesh.tables.derivatives, own_u, inverse_size, at.e);
        write(mesh.tables.values, own_v, 1., at.v);
        write(mesh.tables.derivatives, own_v, inverse_size, at.rate);
      }
    }

    /// Sums of int N phi_i,s and int f phi_i at the nodes of a group, after those of the cells before it; @p f may be
    /// null.
    template <typename Size>
    [[gnu::always_inline]] static inline void
    sum_forces(
      const LaneMesh<Number> &mesh, const Size &h, const Group &group, const Value *N, const Value *f, Number *F)
    {
      if constexpr (width == 1)
      {
        Number *const sums = F + group.first * q;
        if (group.first == 0)
          sums[0] = Number{};
        for (int i = 1; i < n; ++i)
          sums[i] = Number{};
        add_forces<n, Value>(mesh.tables, h, N, f, sums);
      }
      else
      {
        Value sums[n] = {};
        add_forces<n, Value>(mesh.tables, h, N, f, sums, 1, n);
        sums[0] = group.sums_of_left(F, q, sums[q]);
        add_forces<n, Value>(mesh.tables, h, N, f, sums, 0, 1);
        for (int i = q; i >= 0; --i) // the last node of a cell is the first one of the next
          group.store(sums[i], F, q, i);
      }
    }

    /// Residual @p F of the nodes of a group; returns the smallest stretch of each cell.
    template <typename Laws, typename Size>
    [[gnu::always_inline]] static inline Value
    residual_of_group(const LaneMesh<Number> &mesh,
                      const Laws &laws,
                      const Size &h,
                      const Group &group,
                      const Elements &u,
                      const Elements &v,
                      Number *F)
    {
      Value N[n], f[n];
      const auto at = cell_forces<n, Value>(mesh.tables, h, laws, u.begin, v.begin, N, f);
      sum_forces(mesh, h, group, N, v.begin != nullptr ? f : nullptr, F);
      Value least = at.w[0];
      for (int p = 1; p < n; ++p)
        least = smaller(at.w[p], least);
      return least;
    }

    /// Computes the residual: overwrites @p F; returns the smallest stretch at a quadrature point.
    [[gnu::flatten]] static Number
    residual(const LaneMesh<Number> &mesh, const Number *u, const Number *v, const Number *m, Number *F)
    {
      auto least = broadcast<Value>(HUGE_VAL);
      for_cells<Wanted::forces>(mesh, m, [&](const auto &laws, const auto &h, const Group &group) {
        // A stretch that is not a number makes F the same.
        least =
          smaller(residual_of_group(mesh, laws, h, group, Elements(group, u, q), Elements(group, v, q), F), least);
      });
      return Group::over_lanes(least);
    }

    [[gnu::flatten]] static void
    slopes(const LaneMesh<Number> &mesh, const Number *u, const Number *v, const LaneSlopes<Number> &at)
    {
      for_cells<Wanted::slopes>(mesh, nullptr, [&](const auto &laws, const auto &h, const Group &group) {
        const Elements own_u(group, u, q), own_v(group, v, q);
        const auto D = cell_derivatives<n, true, Value>(mesh.tables, h, laws, own_u.begin, own_v.begin);
        for (int p = 0; p < n; ++p)
        {
          group.store(D.f_v[p], at.f_v, n, p);
          group.store(D.f_w[p], at.f_w, n, p);
          if constexpr (std::decay_t<decltype(laws)>::has_one_modulus)
            group.store(laws.k, at.N_w, n, p);
          else
            group.store(D.N_w[p], at.N_w, n, p);
          if (at.f_u != nullptr)
            group.store(D.f_u[p], at.f_u, n, p);
          if (at.N_rate != nullptr)
            group.store(D.N_rate[p], at.N_rate, n, p);
        }
      });
    }

    /// Products of the transposed dF/du and of dF/dv, which is symmetric, with @p x.
    [[gnu::flatten]] static void
    transposed(const LaneMesh<Number> &mesh, const LaneSlopes<Number> &at, const Number *x, Number *K_x, Number *M_x)
    {
      for (int c = 0; c < mesh.n_cells; c += width)
      {
        const Group group(c, mesh.n_cells);
        const auto h = group.load(mesh.sizes, 1, 0);
        const Elements own(group, x, q), f_v(group, at.f_v, n), f_w(group, at.f_w, n), N_w(group, at.N_w, n),
          f_u(group, at.f_u, n), N_rate(group, at.N_rate, n);
        Value here[n], slope[n], N[n], f[n];
        evaluate<n>(mesh.tables.values, own.begin, 1., 0., here);
        evaluate<n>(mesh.tables.derivatives, own.begin, 1. / h, 0., slope);
        for (int p = 0; p < n; ++p)
        {
          N[p] = f_w.begin[p] * here[p] + N_w.begin[p] * slope[p];
          f[p] = f_u.begin != nullptr ? f_u.begin[p] * here[p] : Value{};
        }
        sum_forces(mesh, h, group, N, f_u.begin != nullptr ? f : nullptr, K_x);
        for (int p = 0; p < n; ++p)
        {
          f[p] = f_v.begin[p] * here[p];
          N[p] = N_rate.begin != nullptr ? N_rate.begin[p] * slope[p] : Value{};
        }
        sum_forces(mesh, h, group, N, f, M_x);
      }
    }

    [[gnu::flatten]] static void
    integrals(
      const LaneMesh<Number> &mesh, const Number *u, const Number *v, const Number *m, LaneIntegrals<Number> &sum)
    {
      for_cells<Wanted::forces | Wanted::energies>(mesh, m, [&](const auto &laws, const auto &h, const Group &group) {
        const CellDensities<n, Value> all(
          mesh.tables, h, laws, Elements(group, u, q).begin, Elements(group, v, q).begin);
        for (int l = 0; l < group.n; ++l)
          for (int p = 0; p < n; ++p)
          {
            const double ds = Group::of_lane(h, l) * mesh.tables.weights[p];
            const PointDensities<Number> at{Group::of_lane(all.at[p].elastic_energy, l),
                                            Group::of_lane(all.at[p].power, l),
                                            Group::of_lane(all.at[p].force, l)};
            add_densities(ds, at, Group::of_lane(all.v[p], l), sum);
          }
      });
    }

    /// Smallest and largest stretch among the samples of all cells.
    [[gnu::flatten]] static LaneExtremes<Number>
    extremes(const LaneMesh<Number> &mesh, const int n_samples, const double *sample_derivatives, const Number *u)
    {
      LaneExtremes<Value> result;
      for (int c = 0; c < mesh.n_cells; c += width)
      {
        const Group group(c, mesh.n_cells);
        const Elements own(group, u, q);
        const auto inverse_size = 1. / group.load(mesh.sizes, 1, 0);
        const Value first       = group.numbers() * n_samples;
        for (int i = 0; i < n_samples; ++i)
        {
          Value e{};
          for (int j = 0; j < n; ++j)
            e += sample_derivatives[i * n + j] * own.begin[j];
          result.see(1. + inverse_size * e, first + i);
        }
      }
      return Group::over_lanes(result);
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
