// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace crawler
{
  /**
   * Interpolation by cubic splines over @p knots (at least 4, increasing). The error is O(h^4), that of the derivative
   * O(h^3). At the ends either
   *  - not-a-knot: the third derivative is continuous at the second knot and at the last but one, so that cubic
   *    polynomials are reproduced; or
   *  - periodic: the period is the distance of the outermost knots, whose values must be equal.
   */
  class CubicSpline
  {
  public:
    enum class Ends
    {
      not_a_knot,
      periodic
    };

    explicit CubicSpline(std::vector<double> knots, Ends ends = Ends::not_a_knot);

    /// Second derivatives at the knots of the splines through @p values; these and the result are [knot][spline].
    std::vector<double>
    curvatures(std::span<const double> values, std::size_t n_splines = 1) const;

    /// Interpolation weights at a place between knots.
    struct Place
    {
      std::size_t i;
      double a, b, c, d;
      double da, db, dc, dd;

      /// Value of the spline with the values @p y and curvatures @p M at the knots.
      double
      value(const std::span<const double> y, const std::span<const double> M) const
      {
        return a * y[i] + b * y[i + 1] + c * M[i] + d * M[i + 1];
      }
      double
      derivative(const std::span<const double> y, const std::span<const double> M) const
      {
        return da * y[i] + db * y[i + 1] + dc * M[i] + dd * M[i + 1];
      }
    };

    /// Finds the place of @p x; beyond the ends the outermost cubic continues.
    Place
    place(double x) const;

    std::size_t
    size() const
    {
      return knots_.size();
    }

  private:
    const std::vector<double> knots_;
    const Ends ends_;
    std::vector<double> h_;                      ///< knot i+1 - knot i
    std::vector<double> factor_, pivot_, upper_; ///< the triangular factors of the equations of the inner knots
    std::vector<double> coupling_;               ///< periodic: -d(inner curvatures)/d(curvature of the ends)
    double end_pivot_ = 1.;                      ///< periodic
  };
} // namespace crawler
