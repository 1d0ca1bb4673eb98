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
   * Before the first and after the last s it keeps the value there.
   */
  class GridInterpolation
  {
  public:
    enum class Method
    {
      linear, ///< needs two values of s and of t
      cubic   ///< needs four
    };

    /// What the function is before the first and after the last t.
    enum class Outside
    {
      go_on,   ///< the outermost polynomial
      hold,    ///< the outermost value
      periodic ///< the same as within; at the first and at the last t of the grid the values must be equal
    };

    /// The samples at given points s, which do not change, as functions of t.
    class AtPoints;

    GridInterpolation(GridTable grid, Method method, Outside outside);
    ~GridInterpolation();

    /// The result refers to this object.
    std::unique_ptr<AtPoints>
    at(const std::vector<double> &points) const;

    const GridTable &
    grid() const
    {
      return grid_;
    }

  private:
    /// Functions of t by their values, and curvatures in t if they are splines, at the knots.
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

    const GridTable grid_;
    const Outside outside_;
    std::optional<CubicSpline> in_s_, in_t_;       ///< if cubic
    std::vector<double> curvatures_;               ///< [t][s], in s, if cubic
    mutable std::shared_ptr<const Columns> knots_; ///< of all knots of s, once it is needed
  };

  class GridInterpolation::AtPoints
  {
  public:
    AtPoints(const GridInterpolation &owner, const std::vector<double> &points);

    /// The function at all points into @p result (as long as the list of points).
    void
    values(double t, std::span<double> result);
    /// Its derivative with respect to t; at the kinks of a linear one that of either side.
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
    // Either the columns are functions at the points, or, for many points, those at the knots of s: their values and,
    // if cubic, their curvatures in s. What is fewer is combined from times; the places are then for the second case.
    std::shared_ptr<const Columns> columns_;
    std::vector<CubicSpline::Place> places_;
    std::vector<double> at_knots_;
  };
} // namespace crawler
