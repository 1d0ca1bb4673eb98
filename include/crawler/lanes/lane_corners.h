// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_memory.h>

#include <cstddef>

/// Systems of the nodes between the cells (included by lane_systems.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Tridiagonal system of the nodes between the cells: factors below the diagonal, 1/pivots, upper diagonal. The
  /// systems of all pairs are gone through row by row together: their chains of operations do not wait for each
  /// other.
  template <typename Type>
  struct LaneCorners
  {
    Type *lower, *pivot, *upper;

    void
    lay_out(const std::size_t n, LaneMemory &memory)
    {
      memory.pieces(n, lower, pivot, upper);
    }

    /// Row @p c from the Schur complements [cell][4]; @p diagonal goes on to the next row.
    void
    factorize(const int c, const int n_cells, const Type *schur, Type &diagonal) const
    {
      const Type *S = schur + 4 * c;
      if (c == 0)
        diagonal = S[0];
      pivot[c] = 1. / diagonal;
      upper[c] = S[1];
      lower[c] = S[2] * pivot[c];
      diagonal = S[3];
      diagonal -= lower[c] * upper[c];
      if (c + 1 < n_cells)
        diagonal += S[4];
      else
        pivot[n_cells] = 1. / diagonal;
    }

    void
    eliminate(const int c, const int q, Type *x) const
    {
      x[(c + 1) * q] -= lower[c] * x[c * q];
    }
    void
    substitute(const int c, const int q, Type *x) const
    {
      x[c * q] -= upper[c] * x[(c + 1) * q];
      x[c * q] *= pivot[c];
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
