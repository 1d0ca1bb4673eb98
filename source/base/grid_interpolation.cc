// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/grid_interpolation.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Linear interpolation between knots: the weights of the curvatures are 0.
    CubicSpline::Place
    linear_place(const std::vector<double> &knots, const double x)
    {
      const auto above = std::upper_bound(knots.begin() + 1, knots.end() - 1, x);
      const auto i     = static_cast<std::size_t>(above - knots.begin()) - 1;
      const double h   = knots[i + 1] - knots[i];
      return {i, (knots[i + 1] - x) / h, (x - knots[i]) / h, 0., 0., -1. / h, 1. / h, 0., 0.};
    }
  } // namespace

  GridInterpolation::GridInterpolation(GridTable samples, const Method method, const Outside outside)
    : grid(std::move(samples))
    , outside_(outside)
  {
    if (method != Method::cubic)
      return;
    in_s_.emplace(grid.s);
    in_t_.emplace(grid.t, outside == Outside::periodic ? CubicSpline::Ends::periodic : CubicSpline::Ends::not_a_knot);
    const std::size_t n_s = grid.s.size();
    curvatures_.reserve(grid.values.size());
    for (std::size_t j = 0; j < grid.t.size(); ++j)
    {
      const auto M = in_s_->curvatures({grid.values.data() + j * n_s, n_s});
      curvatures_.insert(curvatures_.end(), M.begin(), M.end());
    }
  }

  CubicSpline::Place
  GridInterpolation::place_in_s(const double s) const
  {
    const double inside = std::clamp(s, grid.s.front(), grid.s.back());
    return in_s_ ? in_s_->place(inside) : linear_place(grid.s, inside);
  }

  CubicSpline::Place
  GridInterpolation::place_in_t(double t) const
  {
    const double first = grid.t.front(), last = grid.t.back();
    if (outside_ == Outside::periodic)
      t -= (last - first) * std::floor((t - first) / (last - first));
    else if (outside_ == Outside::hold)
      t = std::clamp(t, first, last);
    return in_t_ ? in_t_->place(t) : linear_place(grid.t, t);
  }

  GridInterpolation::Columns
  GridInterpolation::make_columns(const std::size_t n, std::vector<double> values) const
  {
    Columns columns{n, std::move(values), {}};
    if (in_t_)
      columns.curvatures = in_t_->curvatures(columns.values, n);
    return columns;
  }

  std::unique_ptr<GridInterpolation::AtPoints>
  GridInterpolation::at(const std::vector<double> &points) const
  {
    return std::make_unique<AtPoints>(*this, points);
  }

  GridInterpolation::AtPoints::AtPoints(const GridInterpolation &owner, const std::vector<double> &points)
    : owner_(owner)
  {
    const std::size_t n_s = owner.grid.s.size(), n_t = owner.grid.t.size(), n = points.size();
    const bool cubic = owner.in_s_.has_value();
    std::vector<CubicSpline::Place> places;
    for (const double s : points)
      places.push_back(owner.place_in_s(s));
    if (n <= n_s)
    {
      std::vector<double> values(n_t * n);
      for (std::size_t j = 0; j < n_t; ++j)
        for (std::size_t i = 0; i < n; ++i)
        {
          const CubicSpline::Place &p = places[i];
          const double *y             = owner.grid.values.data() + j * n_s + p.i;
          double &value               = values[j * n + i];
          value                       = p.a * y[0] + p.b * y[1];
          if (cubic)
          {
            const double *M = owner.curvatures_.data() + j * n_s + p.i;
            value += p.c * M[0] + p.d * M[1];
          }
        }
      columns_ = std::make_shared<const Columns>(owner.make_columns(n, std::move(values)));
      return;
    }
    if (!owner.knots_)
    {
      std::vector<double> values;
      for (std::size_t j = 0; j < n_t; ++j)
      {
        const auto row = static_cast<std::ptrdiff_t>(j * n_s), length = static_cast<std::ptrdiff_t>(n_s);
        values.insert(values.end(), owner.grid.values.begin() + row, owner.grid.values.begin() + row + length);
        if (cubic)
          values.insert(values.end(), owner.curvatures_.begin() + row, owner.curvatures_.begin() + row + length);
      }
      owner.knots_ = std::make_shared<const Columns>(owner.make_columns(cubic ? 2 * n_s : n_s, std::move(values)));
    }
    columns_ = owner.knots_;
    places_  = std::move(places);
    at_knots_.resize(columns_->n);
  }

  void
  GridInterpolation::AtPoints::combine(const std::size_t i, const Weights &w, const std::span<double> result)
  {
    const std::size_t n    = columns_->n;
    const double *const y0 = columns_->values.data() + i * n, *const y1 = y0 + n;
    double *const sum = places_.empty() ? result.data() : at_knots_.data();
    if (columns_->curvatures.empty())
      for (std::size_t c = 0; c < n; ++c)
        sum[c] = w.a * y0[c] + w.b * y1[c];
    else
    {
      const double *const M0 = columns_->curvatures.data() + i * n, *const M1 = M0 + n;
      for (std::size_t c = 0; c < n; ++c)
        sum[c] = w.a * y0[c] + w.b * y1[c] + w.c * M0[c] + w.d * M1[c];
    }
    if (places_.empty())
      return;
    const std::span<const double> y(at_knots_), M = owner_.in_s_ ? y.subspan(owner_.grid.s.size()) : y;
    for (std::size_t p = 0; p < places_.size(); ++p)
      result[p] = places_[p].value(y, M); // c = d = 0 if linear
  }

  void
  GridInterpolation::AtPoints::values(const double t, const std::span<double> result)
  {
    const auto p = owner_.place_in_t(t);
    combine(p.i, {p.a, p.b, p.c, p.d}, result);
  }

  void
  GridInterpolation::AtPoints::rates(const double t, const std::span<double> result)
  {
    if (owner_.outside_ == Outside::hold && (t < owner_.grid.t.front() || t > owner_.grid.t.back()))
    {
      std::fill(result.begin(), result.end(), 0.);
      return;
    }
    const auto p = owner_.place_in_t(t);
    combine(p.i, {p.da, p.db, p.dc, p.dd}, result);
  }
} // namespace crawler
