// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/cell_group.h>
#include <crawler/lanes/lane_kernels.h>

#include <cstddef>

/// Loops over the cells of one body whose cells are in the lanes (included by lane_kernel_table.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Kernels of LaneKernels<double, q> for groups of cells, to which the blocks belong. Sums have the order of one cell
  /// after the other, so that results are the same but for round-off of fused products.
  template <int q>
  struct GroupKernels
  {
    static constexpr int n = q + 1, width = CellGroup::width;
    using Kernels = LaneKernels<Cells, q>;

    /// Cells that the blocks have room for.
    static int
    n_blocks(const int n_cells)
    {
      return (n_cells + width - 1) / width * width;
    }

    /// Calls @p use(laws, sizes, group) for each group; the laws of general bodies have what is asked for.
    template <unsigned int wanted, typename Use>
    [[gnu::always_inline]] static inline void
    for_groups(const LaneMesh<double> &mesh, const double *m, const Use &use)
    {
      const LaneFriction<Cells> power = in_all_lanes(mesh.friction);
      for (int c = 0; c < mesh.n_cells; c += width)
      {
        const CellGroup group(c, mesh.n_cells);
        const Cells h = group.load(mesh.sizes, 1, 0);
        if (mesh.laws != nullptr)
        {
          const GroupLaws<n, wanted> own(*mesh.laws, group);
          use(KnownLaws<n, Cells>{own.laws, 0}, h, group);
          continue;
        }
        Cells stress[n];
        for (int p = 0; m != nullptr && p < n; ++p)
          stress[p] = group.load(m, n, p);
        use(typename Kernels::Laws{broadcast<Cells>(mesh.k), m != nullptr ? stress : nullptr, {power}}, h, group);
      }
    }

    /// Overwrites the residual @p F of the cells' nodes; returns the smallest stretch of each.
    template <typename Laws>
    [[gnu::always_inline]] static inline Cells
    residual(const ElementTables &tables,
             const Laws &laws,
             const Cells &h,
             const CellGroup &group,
             const Nodal<q> &u,
             const Nodal<q> &v,
             double *F)
    {
      Cells N[n], f[n], sums[n] = {};
      const auto at     = cell_forces<n, Cells>(tables, h, laws, u.begin, v.begin, N, f);
      const Cells *both = v.begin != nullptr ? f : nullptr;
      add_forces<n, Cells>(tables, h, N, both, sums, 1, n);
      for (int i = 1; i < n; ++i)
        group.store(sums[i], F, q, i);
      // The first node of a cell is the last of the one before it, which comes first in its sum.
      sums[0][0] = group.first == 0 ? 0. : F[group.first * q];
      for (int l = 1; l < width; ++l)
        sums[0][l] = sums[q][l - 1];
      add_forces<n, Cells>(tables, h, N, both, sums, 0, 1);
      group.store(sums[0], F, q, 0);
      Cells least = at.w[0];
      for (int p = 1; p < n; ++p)
        least = smaller(at.w[p], least);
      return least;
    }

    [[gnu::flatten]] static double
    residual(const LaneMesh<double> &mesh, const double *u, const double *v, const double *m, double *F)
    {
      auto least = broadcast<Cells>(HUGE_VAL);
      for_groups<Wanted::forces>(mesh, m, [&](const auto &laws, const Cells &h, const CellGroup &group) {
        least = smaller(residual(mesh.tables, laws, h, group, Nodal<q>(group, u), Nodal<q>(group, v), F), least);
      });
      double result = HUGE_VAL;
      for (int l = 0; l < width; ++l)
        result = smaller(least[l], result);
      return result;
    }

    /// Factors of the blocks @p A, and their Schur complements.
    template <typename Number>
    [[gnu::always_inline]] static inline void
    condense(const CellGroup &group, typename CellsOf<Number>::Type *A, Number *blocks, Number *schur)
    {
      typename CellsOf<Number>::Type corners[4];
      condense_cell<q>(A, corners, [](const auto &) {}); // what is not finite is seen in the solution
      auto *own = reinterpret_cast<typename CellsOf<Number>::Type *>(blocks + group.first * n * n);
      for (int i = 0; i < n * n; ++i)
        own[i] = A[i];
      for (int i = 0; i < 4; ++i)
        group.store(corners[i], schur, 4, i);
    }

    [[gnu::flatten]] static void
    balance(const LaneMesh<double> &mesh,
            const double *u,
            const double *v,
            const double *m,
            double *F,
            double *blocks,
            double *schur)
    {
      for_groups<Wanted::forces | Wanted::slopes>(
        mesh, m, [&](const auto &laws, const Cells &h, const CellGroup &group) {
          const Nodal<q> own_u(group, u), own_v(group, v);
          residual(mesh.tables, laws, h, group, own_u, own_v, F);
          Cells A[n * n];
          cell_blocks<n, false, Cells>(mesh.tables, h, laws, own_u.begin, own_v.begin, nullptr, A);
          condense(group, A, blocks, schur);
        });
      for (int i = 0; i <= mesh.n_cells * q; ++i)
        F[i] = -F[i];
    }

    template <bool is_transposed>
    [[gnu::flatten]] static void
    factorize(const LaneMesh<double> &mesh,
              const double *u,
              const double *v,
              const double &real,
              const int n_pairs,
              const Complex<double> *shifts,
              double *blocks,
              double *schur,
              Complex<double> *complex_blocks,
              Complex<double> *complex_schur)
    {
      const std::size_t stride = std::size_t(n_blocks(mesh.n_cells)) * n * n;
      for_groups<Wanted::slopes>(mesh, nullptr, [&](const auto &laws, const Cells &h, const CellGroup &group) {
        Cells K[n * n], M[n * n], A[n * n];
        cell_blocks<n, true>(mesh.tables, h, laws, Nodal<q>(group, u).begin, Nodal<q>(group, v).begin, K, M);
        if constexpr (is_transposed)
          Kernels::transpose(K);
        for (int i = 0; i < n * n; ++i)
          A[i] = K[i] + real * M[i];
        condense(group, A, blocks, schur);
        for (int j = 0; j < n_pairs; ++j)
        {
          Complex<Cells> B[n * n];
          for (int i = 0; i < n * n; ++i)
            B[i] = {K[i] + shifts[j].re * M[i], shifts[j].im * M[i]};
          condense(group, B, complex_blocks + j * stride, complex_schur + 4 * j * mesh.n_cells);
        }
      });
    }

    [[gnu::flatten]] static void
    integrals(
      const LaneMesh<double> &mesh, const double *u, const double *v, const double *m, LaneIntegrals<double> &sum)
    {
      for_groups<Wanted::forces | Wanted::energies>(
        mesh, m, [&](const auto &laws, const Cells &h, const CellGroup &group) {
          const CellDensities<n, Cells> all(mesh.tables, h, laws, Nodal<q>(group, u).begin, Nodal<q>(group, v).begin);
          for (int l = 0; l < group.n; ++l)
            for (int p = 0; p < n; ++p)
            {
              const double ds = h[l] * mesh.tables.weights[p];
              const PointDensities<double> at{all.at[p].elastic_energy[l], all.at[p].power[l], all.at[p].force[l]};
              sum.displacement += ds * all.u[p][l];
              add_densities(ds, at, all.v[p][l], sum);
            }
        });
    }

    [[gnu::flatten]] static void
    extremes(const LaneMesh<double> &mesh,
             const int n_samples,
             const double *sample_derivatives,
             const double *u,
             LaneLook<double> &look)
    {
      LaneLook<Cells> all;
      for (int c = 0; c < mesh.n_cells; c += width)
      {
        const CellGroup group(c, mesh.n_cells);
        const Nodal<q> own(group, u);
        const Cells inverse_size = 1. / group.load(mesh.sizes, 1, 0), first = group.numbers() * n_samples;
        for (int i = 0; i < n_samples; ++i)
          Kernels::look_at_sample(sample_derivatives + i * n, inverse_size, own.begin, first + i, all);
      }
      for (int l = 0; l < width; ++l) // of equal stretches the first one counts
      {
        const double low = all.least[l], high = all.most[l];
        if (low < look.least || (low == look.least && all.min_at[l] < look.min_at))
        {
          look.least  = low;
          look.min_at = all.min_at[l];
        }
        if (high > look.most || (high == look.most && all.max_at[l] < look.max_at))
        {
          look.most   = high;
          look.max_at = all.max_at[l];
        }
      }
    }

    template <typename Number, typename Group>
    [[gnu::always_inline]] static inline void
    eliminate(const CellGroup &group, const Group *A, const int end, Group *y, Number *x)
    {
      y[end] = group.load(x, q, end);
      eliminate_inner<q>(A, end, y);
      group.store(y[end], x, q, end);
    }

    /// Calls @p use(group, blocks of the group) for each group of the cells.
    template <typename Number, typename Use>
    [[gnu::always_inline]] static inline void
    for_blocks(const int n_cells, const Number *blocks, const Use &use)
    {
      for (int c = 0; c < n_cells; c += width)
        use(CellGroup(c, n_cells), reinterpret_cast<const typename CellsOf<Number>::Type *>(blocks + c * n * n));
    }

    template <typename Number>
    [[gnu::flatten]] static void
    forward(const int n_cells, const Number *blocks, Number *x)
    {
      for_blocks(n_cells, blocks, [x](const CellGroup &group, const auto *A) {
        typename CellsOf<Number>::Type y[n];
        for (int i = 1; i < q; ++i)
          y[i] = group.load(x, q, i);
        solve_inner<q>(A, y);
        for (int i = 1; i < q; ++i)
          group.store(y[i], x, q, i);
        eliminate(group, A, q, y, x); // the left cell of a node comes first
        eliminate(group, A, 0, y, x);
      });
    }

    template <typename Number>
    [[gnu::flatten]] static void
    backward(const int n_cells, const Number *blocks, Number *x)
    {
      for_blocks(n_cells, blocks, [x](const CellGroup &group, const auto *A) {
        typename CellsOf<Number>::Type y[n];
        for (int i = 0; i < n; ++i)
          y[i] = group.load(x, q, i);
        backward_cell<q>(A, y);
        for (int i = 1; i < q; ++i)
          group.store(y[i], x, q, i);
      });
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
