// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <complex>
#include <vector>

namespace crawler
{
  /**
   * The Radau IIA method with s = 3 or 5 stages, collocation at the Radau points 0 < c_1 < ... < c_s = 1, of order
   * 2s-1 (Hairer and Wanner @cite HairerWanner1996, sections IV.5 and IV.8). Matrices row by row.
   */
  struct RadauTableau
  {
    explicit RadauTableau(unsigned int n_stages);

    const unsigned int n; ///< s
    /// Remaining error of Newton's method in a step, relative to the admissible error of the step. The end of a step is
    /// much more accurate than its error bound, so Newton's method must be, too.
    const double newton_fraction;
    std::vector<double> c;                         ///< [s] the nodes
    std::vector<double> b;                         ///< [s] the weights, exact for polynomials up to degree 2s-2
    std::vector<double> inverse;                   ///< [s][s] A^-1 of the Runge-Kutta matrix A
    double real_eigenvalue = 0.;                   ///< of A^-1
    std::vector<std::complex<double>> eigenvalues; ///< [(s-1)/2] of A^-1, with positive imaginary part
    /// Eigenvectors of A^-1, the real one first, and the inverse of their matrix, without parts that are complex
    /// conjugates of others.
    std::vector<std::complex<double>> vectors; ///< [s][1 + (s-1)/2]
    std::vector<std::complex<double>> rows;    ///< [1 + (s-1)/2][s]
    /// Weights [s] of the increments z_j in the error: h (b^ - b) f = sum_j error_weights_j z_j for the embedded
    /// formula of order s, which has the weight 1/real_eigenvalue at the start of the step (section IV.8, formula
    /// 8.18).
    std::vector<double> error_weights;

    unsigned int
    n_pairs() const
    {
      return (n - 1) / 2;
    }
  };

  /// Real and imaginary parts in alternation, as the C++ standard lays them out.
  inline const double *
  parts(const std::vector<std::complex<double>> &values)
  {
    return reinterpret_cast<const double *>(values.data());
  }

  /// Tableau of a method. Throws std::logic_error unless @p n_stages is 3, 5 or 7; runs use the first two.
  const RadauTableau &
  radau_tableau(unsigned int n_stages);
} // namespace crawler
