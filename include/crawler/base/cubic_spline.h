// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace crawler
{
  /**
   * Interpolation by cubic splines over @p knots (at least 4, increasing), with the not-a-knot condition at both ends:
   * the third derivative is continuous at the second knot and at the last but one, so that cubic polynomials are
   * reproduced. The error is O(h^4), that of the derivative O(h^3).
   */
  class CubicSpline
  {
  public:
    explicit CubicSpline(std::vector<double> knots);

    /// The second derivatives at the knots of the spline through @p values (as long as the knots).
    std::vector<double>
    curvatures(std::span<const double> values) const;

    /// A place between the knots: value = a y_i + b y_(i+1) + c M_i + d M_(i+1), with the values y and curvatures M;
    /// and the same for the derivative.
    struct Place
    {
      std::size_t i;
      double a, b, c, d;
      double da, db, dc, dd;
    };

    /// Where @p x is; beyond the ends the outermost cubic goes on.
    Place
    place(double x) const;

    std::size_t
    size() const
    {
      return knots_.size();
    }

  private:
    const std::vector<double> knots_;
  };
} // namespace crawler
