// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>

/**
 * Elimination of the inner nodes 1 ... q-1 of one cell from its dense block, [n][n] with n = q+1. Number is real,
 * complex, or a pack of either. Included where it is compiled; users include block_tridiagonal_kernels.h. After
 * condense_cell() a block holds
 *  - [1..q-1][1..q-1]: L (unit diagonal not stored) and U of A_ii, with 1/U_ii on the diagonal;
 *  - [1..q-1][0 and q]: X = A_ii^-1 A_ib;
 *  - [0 and q][1..q-1]: A_bi.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Overwrites the block @p A by its factors and writes the 2x2 Schur complement of the end nodes. @p usable(pivot)
  /// sees all pivots.
  template <int q, typename Number, typename Usable>
  inline void
  condense_cell(Number *A, Number *schur, const Usable &usable)
  {
    constexpr int n = q + 1;
    for (int k = 1; k < q; ++k)
    {
      usable(A[k * n + k]);
      const Number inverse = 1. / A[k * n + k];
      A[k * n + k]         = inverse;
      for (int i = k + 1; i < q; ++i)
      {
        const Number factor = A[i * n + k] * inverse;
        A[i * n + k]        = factor;
        for (int j = k + 1; j < q; ++j)
          A[i * n + j] -= factor * A[k * n + j];
        A[i * n] -= factor * A[k * n];
        A[i * n + q] -= factor * A[k * n + q];
      }
    }
    for (int k = q - 1; k >= 1; --k)
    {
      Number left = A[k * n], right = A[k * n + q];
      for (int j = k + 1; j < q; ++j)
      {
        left -= A[k * n + j] * A[j * n];
        right -= A[k * n + j] * A[j * n + q];
      }
      A[k * n]     = left * A[k * n + k];
      A[k * n + q] = right * A[k * n + k];
    }
    Number s00 = A[0], s01 = A[q], s10 = A[q * n], s11 = A[q * n + q];
    for (int k = 1; k < q; ++k)
    {
      s00 -= A[k] * A[k * n];
      s01 -= A[k] * A[k * n + q];
      s10 -= A[q * n + k] * A[k * n];
      s11 -= A[q * n + k] * A[k * n + q];
    }
    schur[0] = s00;
    schur[1] = s01;
    schur[2] = s10;
    schur[3] = s11;
  }

  /// Solves for the inner nodes of the right-hand side @p y of the cell's nodes, those at its ends being 0.
  template <int q, typename Number>
  inline void
  solve_inner(const Number *A, Number *y)
  {
    constexpr int n = q + 1;
    for (int i = 2; i < q; ++i)
      for (int j = 1; j < i; ++j)
        y[i] -= A[i * n + j] * y[j];
    for (int i = q - 1; i >= 1; --i)
    {
      for (int j = i + 1; j < q; ++j)
        y[i] -= A[i * n + j] * y[j];
      y[i] *= A[i * n + i];
    }
  }

  /// Takes the inner nodes out of the right-hand side of the node @p end, 0 or q.
  template <int q, typename Number>
  inline void
  eliminate_inner(const Number *A, const int end, Number *y)
  {
    for (int i = 1; i < q; ++i)
      y[end] -= A[end * (q + 1) + i] * y[i];
  }

  /// Recovers the inner nodes from the solution at the end nodes.
  template <int q, typename Number>
  inline void
  backward_cell(const Number *A, Number *y)
  {
    constexpr int n = q + 1;
    for (int i = 1; i < q; ++i)
      y[i] -= A[i * n] * y[0] + A[i * n + q] * y[q];
  }
} // namespace crawler::CRAWLER_INSTRUCTION_SET
