// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>
#include <complex>

namespace crawler
{
  inline bool
  is_finite(const double x)
  {
    return std::isfinite(x);
  }
  inline bool
  is_finite(const std::complex<double> x)
  {
    return std::isfinite(x.real()) && std::isfinite(x.imag());
  }

  /// Loops over the dense blocks [cell][degree+1][degree+1] of a block-tridiagonal matrix, compiled for each degree;
  /// real or complex numbers.
  template <typename Number>
  struct BlockTridiagonalKernels
  {
    /// y += A x.
    void (*multiply)(unsigned int n_cells, const Number *blocks, const Number *x, Number *y);
    /**
     * Static condensation of every cell's inner nodes. In: the blocks. Out: `blocks` overwritten by the factors and
     * the 2x2 Schur complements [cell][4] of the end nodes. Returns false if a pivot is zero or not finite.
     */
    bool (*condense)(unsigned int n_cells, Number *blocks, Number *schur);
    /// Eliminates the inner nodes from the right-hand side @p x (in place).
    void (*forward)(unsigned int n_cells, const Number *blocks, Number *x);
    /// Recovers the inner nodes from the end nodes of all cells (in place).
    void (*backward)(unsigned int n_cells, const Number *blocks, Number *x);
  };

  /// Returns the kernels for one degree, 1 to ReferenceElement::highest_degree.
  template <typename Number>
  const BlockTridiagonalKernels<Number> &
  block_tridiagonal_kernels(unsigned int degree);
} // namespace crawler
