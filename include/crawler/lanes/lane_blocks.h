// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_kernels.h>
#include <crawler/mesh/block_tridiagonal_loops.h>

#include <cstddef>

/// Matrices of all cells: their blocks, and the elimination of the inner nodes (included by lane_kernel_table.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Kernels for the blocks [cell][n][n]; with a CellGroup those of a group are side by side.
  template <typename Group, int q>
  struct LaneBlocks : LaneKernels<Group, q>
  {
    using Kernels = LaneKernels<Group, q>;
    using Kernels::n, Kernels::width;
    using typename Kernels::Number, typename Kernels::Value, typename Kernels::Elements;

    /// Cells that the blocks have room for.
    static int
    n_blocks(const int n_cells)
    {
      return (n_cells + width - 1) / width * width;
    }

    /// Blocks of a group.
    template <typename Type>
    static typename Group::template Of<Type> *
    own_blocks(const Group &group, Type *blocks)
    {
      return reinterpret_cast<typename Group::template Of<Type> *>(blocks + group.first * n * n);
    }
    template <typename Type>
    static const typename Group::template Of<Type> *
    own_blocks(const Group &group, const Type *blocks)
    {
      return reinterpret_cast<const typename Group::template Of<Type> *>(blocks + group.first * n * n);
    }

    /// Overwrites the block @p A of each cell of a group by its factors, and writes the Schur complements.
    template <typename Own, typename Type>
    [[gnu::always_inline]] static inline void
    condense(const Group &group, Own *A, Type *schur)
    {
      Own corners[4];
      condense_cell<q>(A, corners, [](const auto &) {}); // non-finite factors show in the solution
      for (int i = 0; i < 4; ++i)
        group.store(corners[i], schur, 4, i);
    }

    /// Right-hand side of M x = F for the correction x of the velocity @p v to that in which all forces balance, and
    /// the factors of M. Without @p v, for plain bodies, x is the velocity.
    [[gnu::flatten]] static void
    balance(const LaneMesh<Number> &mesh,
            const Number *u,
            const Number *v,
            const Number *m,
            Number *F,
            Number *blocks,
            Number *schur)
    {
      Kernels::template for_cells<Wanted::forces | Wanted::slopes>(
        mesh, m, [&](const auto &laws, const auto &h, const Group &group) {
          const Elements own_u(group, u, q), own_v(group, v, q);
          Kernels::residual_of_group(mesh, laws, h, group, own_u, own_v, F);
          Value *const M = own_blocks(group, blocks);
          cell_blocks<n, false, Value>(mesh.tables, h, laws, own_u.begin, own_v.begin, nullptr, M);
          condense(group, M, schur);
        });
      for (int i = 0; i <= mesh.n_cells * q; ++i)
        F[i] = -F[i];
    }

    static void
    transpose(Value *K)
    {
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j)
        {
          const Value lower = K[i * n + j];
          K[i * n + j]      = K[j * n + i];
          K[j * n + i]      = lower;
        }
    }

    /// The factors of K + real M, and of K + (re + i im) M for each pair; with the transposed K if so wished.
    template <bool is_transposed>
    [[gnu::flatten]] static void
    factorize(const LaneMesh<Number> &mesh,
              const Number *u,
              const Number *v,
              const Number &real,
              const int n_pairs,
              const Complex<Number> *shifts,
              Number *blocks,
              Number *schur,
              Complex<Number> *complex_blocks,
              Complex<Number> *complex_schur)
    {
      const std::size_t stride = std::size_t(n_blocks(mesh.n_cells)) * n * n;
      Kernels::template for_cells<Wanted::slopes>(
        mesh, nullptr, [&](const auto &laws, const auto &h, const Group &group) {
          Value K[n * n], M[n * n];
          cell_blocks<n, true>(mesh.tables, h, laws, Elements(group, u, q).begin, Elements(group, v, q).begin, K, M);
          if constexpr (is_transposed)
            transpose(K);
          Value *const A = own_blocks(group, blocks);
          for (int i = 0; i < n * n; ++i)
            A[i] = K[i] + real * M[i];
          condense(group, A, schur);
          for (int j = 0; j < n_pairs; ++j)
          {
            Complex<Value> *const B = own_blocks(group, complex_blocks + j * stride);
            for (int i = 0; i < n * n; ++i)
              B[i] = {K[i] + shifts[j].re * M[i], shifts[j].im * M[i]};
            condense(group, B, complex_schur + 4 * j * mesh.n_cells);
          }
        });
    }

    template <typename Type>
    [[gnu::flatten]] static void
    forward(const int n_cells, const Type *blocks, Type *x)
    {
      for (int c = 0; c < n_cells; c += width)
      {
        const Group group(c, n_cells);
        const auto *const A = own_blocks(group, blocks);
        typename Group::template Nodes<Type, q> y(group, x);
        y.load(1, q);
        solve_inner<q>(A, y.values);
        y.store(1, q);
        const auto eliminate = [&](const int end) {
          y.load(end, end + 1);
          eliminate_inner<q>(A, end, y.values);
          y.store(end, end + 1);
        };
        eliminate(q); // the left cell of a node comes first
        eliminate(0);
      }
    }

    template <typename Type>
    [[gnu::flatten]] static void
    backward(const int n_cells, const Type *blocks, Type *x)
    {
      for (int c = 0; c < n_cells; c += width)
      {
        const Group group(c, n_cells);
        typename Group::template Nodes<Type, q> y(group, x);
        y.load(0, n);
        backward_cell<q>(own_blocks(group, blocks), y.values);
        y.store(1, q);
      }
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
