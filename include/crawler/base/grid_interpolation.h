// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/cubic_spline.h>
#include <crawler/base/grid_table.h>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /**
   * A function of s and t through samples on a grid, linear or by cubic splines in both directions (tensor product).
   * Before the first and after the last s it is constant.
   */
  class GridInterpolation
  {
  public:
    enum class Method
    {
      linear, ///< needs two values of s and of t
      cubic   ///< needs four
    };

    /// Continuation before the first and after the last t.
    enum class Outside
    {
      go_on,   ///< the outermost polynomial
      hold,    ///< the outermost value
      periodic ///< the values at the first and the last t of the grid must be equal
    };

    /// The function at fixed points s, as functions of t.
    class AtPoints;

    GridInterpolation(GridTable samples, Method method, Outside outside);

    /// Evaluator at the points, which refers to this object.
    std::unique_ptr<AtPoints>
    at(const std::vector<double> &points) const;

    const GridTable grid;

  private:
    /// Functions of t by their values at the knots, and their curvatures in t if they are splines.
    struct Columns
    {
      std::size_t n;
      std::vector<double> values, curvatures; ///< [t][column]
    };

    CubicSpline::Place
    place_in_s(double s) const;
    CubicSpline::Place
    place_in_t(double t) const;
    Columns
    make_columns(std::size_t n, std::vector<double> values) const;

    const Outside outside_;
    std::optional<CubicSpline> in_s_, in_t_;       ///< if cubic
    std::vector<double> curvatures_;               ///< [t][s], in s, if cubic
    mutable std::shared_ptr<const Columns> knots_; ///< at all knots of s, made on first use
  };

  class GridInterpolation::AtPoints
  {
  public:
    AtPoints(const GridInterpolation &owner, const std::vector<double> &points);

    /// Writes the function at all points into @p result (as long as the list of points).
    void
    values(double t, std::span<double> result);
    /// Writes its derivative with respect to t; at the kinks of a linear interpolation that of either side.
    void
    rates(double t, std::span<double> result);

  private:
    struct Weights
    {
      double a, b, c, d;
    };

    void
    combine(std::size_t i, const Weights &weights, std::span<double> result);

    const GridInterpolation &owner_;
    // Columns are functions at the points or, if there are more points than knots of s, at the knots: their values and,
    // if cubic, their curvatures in s. In that case `places_` interpolate between them at each time.
    std::shared_ptr<const Columns> columns_;
    std::vector<CubicSpline::Place> places_;
    std::vector<double> at_knots_;
  };
} // namespace crawler
