// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/cubic_spline.h>

#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /// A cubic spline with values.
  class SplineCurve
  {
  public:
    SplineCurve(std::shared_ptr<const CubicSpline> knots, std::vector<double> values, std::vector<double> curvatures)
      : knots_(std::move(knots))
      , values_(std::move(values))
      , curvatures_(std::move(curvatures))
    {
    }

    /// Beyond the ends the outermost cubic goes on.
    double
    value(double x) const;
    double
    derivative(double x) const;

    /// At the knots.
    const std::vector<double> &
    values() const
    {
      return values_;
    }
    const std::vector<double> &
    curvatures() const
    {
      return curvatures_;
    }

  private:
    std::shared_ptr<const CubicSpline> knots_;
    std::vector<double> values_, curvatures_;
  };

  /**
   * The smoothing spline over @p knots (at least 4, increasing): the function f that makes
   *   sum_i w_i (y_i - f(x_i))^2 + lambda int f''^2 dx
   * smallest (Reinsch 1967), with lambda = (width/2 pi)^4/h and the mean step h of the knots. From many equally spaced
   * samples a wave of the length P is kept to the part 1/(1 + (width/P)^4): the width is the length of the waves that
   * are halved. With width 0 f goes through the samples (CubicSpline).
   *  - not-a-knot: the polynomial that is next to the samples is taken away before and added again, so that cubic
   *    polynomials are reproduced at any width, and f'' = 0, which the functional asks for at the ends, is asked of the
   *    rest only. Its degree is 1 + length/width, from 3 to 9, and at most 2 sqrt(number of knots) - 1; 3 if no more
   *    than four samples are within a width of the ends. Of the rest a cubic is taken away in the same way, whose f''
   * at each end is that of the cubic nearest to the samples within a width of it, or of the spline through the samples
   *    if these are no more than four: else the slope there would be wrong by a third where waves are thrice as long as
   *    the width;
   *  - periodic: as in CubicSpline, the last knot is the first one of the next period.
   */
  class SmoothingSpline
  {
  public:
    /// @p weights w_i: those of all knots, 1 if there are none; periodic: that of the last knot is not used.
    SmoothingSpline(std::vector<double> knots,
                    double width,
                    CubicSpline::Ends ends      = CubicSpline::Ends::not_a_knot,
                    std::vector<double> weights = {});

    /// The curve for @p values (as long as the knots).
    SplineCurve
    curve(std::span<const double> values) const;

  private:
    /// The equations (R + lambda Q^T W^-1 Q) M = Q^T y for the curvatures M.
    void
    factorise();
    void
    solve(std::vector<double> &right_side) const;

    struct Entry
    {
      std::size_t column;
      double value;
    };
    /// Row k of Q, and the place of unknown i in the ordering that keeps the band of a period narrow.
    std::vector<Entry>
    row_of_q(std::size_t k) const;
    std::size_t
    place(std::size_t i) const;

    const std::vector<double> knots_;
    const bool is_periodic_;
    const double width_;
    std::vector<double> weights_;
    double lambda_          = 0.;
    std::size_t n_unknowns_ = 0;
    std::vector<double> band_; ///< the factors L and D of the matrix, [row][distance from the diagonal]
    std::shared_ptr<const CubicSpline> spline_;
  };
} // namespace crawler
