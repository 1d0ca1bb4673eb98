// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/discretization.h>

#include <utility>

namespace crawler
{
  /**
   * A block-tridiagonal matrix: a chain of dense blocks, one per cell, neighbours overlapping in one node. Its direct
   * solution takes O(N) operations without fill and without pivoting: inner nodes cell by cell, then the end nodes of
   * the cells in turn down to a 2x2 system per rank, then the small tridiagonal system of these on every rank. Number
   * is double or std::complex<double>.
   */
  template <typename Number>
  class BlockTridiagonalMatrix
  {
  public:
    explicit BlockTridiagonalMatrix(const Discretization &discretization);

    /// The blocks [local cell][degree+1][degree+1], row by row, to be filled. Filling them invalidates the factors.
    std::vector<Number> blocks;

    /// y = A x for owned vectors (collective); only of a real matrix.
    void
    multiply(std::span<const Number> x, std::span<Number> y) const;

    /// Computes the factors (collective). Returns false on all ranks if a pivot vanishes or is not finite.
    bool
    factorize();

    /// x = A^-1 b for owned vectors (collective) with the factors; @p b and @p x may be one vector.
    void
    solve(std::span<const Number> b, std::span<Number> x) const;

  private:
    std::pair<Number, Number>
    solve_shared(Number first, Number last) const;

    const Discretization *discretization_;
    std::vector<Number> factors_, schur_;

    // Elimination of the end nodes 1 ... n-1 of the own cells, keeping nodes 0 and n. For node i: its inverse pivot,
    // and its couplings in row/column 0 and to the next node.
    std::vector<Number> inverse_, row_zero_, column_zero_, next_, below_;
    std::vector<Number> reduced_; ///< [rank][4] the 2x2 systems of all ranks
    mutable std::vector<Number> local_, reduced_rhs_;
    mutable std::vector<Number> x_local_;
  };

  template <>
  void
  BlockTridiagonalMatrix<double>::multiply(std::span<const double> x, std::span<double> y) const;
} // namespace crawler
