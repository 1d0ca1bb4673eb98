// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/smoothing_spline.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace crawler
{
  namespace
  {
    constexpr std::size_t width_of_band     = 4;
    constexpr std::size_t least_polynomials = 4; ///< cubics are reproduced

    /// Legendre polynomials of degree 0 to n - 1 at x in [-1, 1], and their second derivatives.
    struct Polynomials
    {
      std::vector<double> values, curvatures;

      Polynomials(const double x, const std::size_t n)
        : values(n, 1.)
        , curvatures(n, 0.)
      {
        std::vector<double> slopes(n, 0.);
        for (std::size_t k = 1; k < n; ++k)
        {
          const auto m  = static_cast<double>(k);
          values[k]     = k == 1 ? x : ((2. * m - 1.) * x * values[k - 1] - (m - 1.) * values[k - 2]) / m;
          slopes[k]     = (k == 1 ? 0. : slopes[k - 2]) + (2. * m - 1.) * values[k - 1];
          curvatures[k] = (k == 1 ? 0. : curvatures[k - 2]) + (2. * m - 1.) * slopes[k - 1];
        }
      }
    };

    /// Of the waves longer than the width: one half wave for each degree, as far as the samples bear it.
    std::size_t
    number_of_polynomials(const std::size_t n_knots, const double length, const double width)
    {
      constexpr double least = least_polynomials, most = 10.;
      const double wanted = 2. + std::round(length / width), bearable = 2. * std::sqrt(static_cast<double>(n_knots));
      return static_cast<std::size_t>(std::clamp(std::floor(std::min(wanted, bearable)), least, most));
    }

    /// Coefficients of the polynomial nearest to the values, by the normal equations.
    std::vector<double>
    nearest_polynomial(const std::vector<double> &x,
                       const std::span<const double> y,
                       const std::vector<double> &weights,
                       const std::size_t n)
    {
      std::vector<std::vector<double>> a(n, std::vector<double>(n + 1, 0.));
      for (std::size_t k = 0; k < x.size(); ++k)
      {
        const std::vector<double> p = Polynomials(x[k], n).values;
        for (std::size_t i = 0; i < n; ++i)
        {
          for (std::size_t j = 0; j < n; ++j)
            a[i][j] += weights[k] * p[i] * p[j];
          a[i][n] += weights[k] * p[i] * y[k];
        }
      }
      for (std::size_t i = 0; i < n; ++i) // positive definite: no pivoting is needed
        for (std::size_t r = 0; r < n; ++r)
          if (r != i)
          {
            const double factor = a[r][i] / a[i][i];
            for (std::size_t j = i; j <= n; ++j)
              a[r][j] -= factor * a[i][j];
          }
      std::vector<double> result(n);
      for (std::size_t i = 0; i < n; ++i)
        result[i] = a[i][n] / a[i][i];
      return result;
    }

    /// f'' at the end where @p x begins: that of the cubic nearest to the first @p n values.
    double
    end_curvature(const std::vector<double> &x,
                  const std::vector<double> &y,
                  const std::vector<double> &weights,
                  const std::size_t n)
    {
      const double half = 0.5 * (x[n - 1] - x[0]);
      std::vector<double> scaled(n);
      for (std::size_t i = 0; i < n; ++i)
        scaled[i] = (x[i] - x[0]) / half - 1.;
      const std::vector<double> nearest = nearest_polynomial(scaled, y, weights, least_polynomials);
      const Polynomials at_end(-1., least_polynomials);
      return std::inner_product(nearest.begin(), nearest.end(), at_end.curvatures.begin(), 0.) / (half * half);
    }

    std::vector<double>
    reversed(std::vector<double> list)
    {
      std::ranges::reverse(list);
      return list;
    }
  } // namespace

  double
  SplineCurve::value(const double x) const
  {
    const CubicSpline::Place p = knots_->place(x);
    return p.a * values_[p.i] + p.b * values_[p.i + 1] + p.c * curvatures_[p.i] + p.d * curvatures_[p.i + 1];
  }

  double
  SplineCurve::derivative(const double x) const
  {
    const CubicSpline::Place p = knots_->place(x);
    return p.da * values_[p.i] + p.db * values_[p.i + 1] + p.dc * curvatures_[p.i] + p.dd * curvatures_[p.i + 1];
  }

  SmoothingSpline::SmoothingSpline(std::vector<double> knots,
                                   const double width,
                                   const CubicSpline::Ends ends,
                                   std::vector<double> weights)
    : knots_(std::move(knots))
    , is_periodic_(ends == CubicSpline::Ends::periodic)
    , width_(width)
    , weights_(std::move(weights))
    , spline_(std::make_shared<CubicSpline>(knots_, ends))
  {
    if (width <= 0.)
      return;
    const auto n_steps = static_cast<double>(knots_.size() - 1);
    lambda_            = std::pow(width / (2. * std::numbers::pi), 4) * n_steps / (knots_.back() - knots_.front());
    if (weights_.empty())
      weights_.assign(knots_.size(), 1.);
    n_unknowns_ = is_periodic_ ? knots_.size() - 1 : knots_.size() - 2;
    factorise();
  }

  std::size_t
  SmoothingSpline::place(const std::size_t i) const
  {
    if (!is_periodic_)
      return i;
    return 2 * i < n_unknowns_ ? 2 * i : 2 * (n_unknowns_ - 1 - i) + 1; // both ends of the period side by side
  }

  std::vector<SmoothingSpline::Entry>
  SmoothingSpline::row_of_q(const std::size_t k) const
  {
    const auto h = [&](const std::size_t i) { return knots_[i + 1] - knots_[i]; };
    std::vector<Entry> row;
    if (is_periodic_)
    {
      const std::size_t n = n_unknowns_, before = (k + n - 1) % n, after = (k + 1) % n;
      row = {{before, 1. / h(before)}, {k, -1. / h(before) - 1. / h(k)}, {after, 1. / h(k)}};
      return row;
    }
    if (k >= 2)
      row.push_back({k - 2, 1. / h(k - 1)});
    if (k >= 1 && k - 1 < n_unknowns_)
      row.push_back({k - 1, -1. / h(k - 1) - 1. / h(k)});
    if (k < n_unknowns_)
      row.push_back({k, 1. / h(k)});
    return row;
  }

  void
  SmoothingSpline::factorise()
  {
    constexpr std::size_t stride = width_of_band + 1;
    band_.assign(n_unknowns_ * stride, 0.);
    const auto add = [&](const std::size_t i, const std::size_t j, const double value) {
      const std::size_t row = place(i), column = place(j);
      if (row >= column)
        band_[row * stride + row - column] += value;
    };
    const std::size_t n_rows = is_periodic_ ? n_unknowns_ : knots_.size();
    for (std::size_t k = 0; k < n_rows; ++k)
    {
      const std::vector<Entry> row = row_of_q(k);
      for (const Entry &a : row)
        for (const Entry &b : row)
          add(a.column, b.column, lambda_ / weights_[k] * a.value * b.value);
    }
    for (std::size_t i = 0; i + 1 < knots_.size(); ++i) // hat functions over each step
    {
      const double h      = knots_[i + 1] - knots_[i];
      const std::size_t n = n_unknowns_, left = is_periodic_ ? i : i - 1, right = is_periodic_ ? (i + 1) % n : i;
      const bool has_left = is_periodic_ || i > 0, has_right = is_periodic_ || i < n;
      if (has_left)
        add(left, left, h / 3.);
      if (has_right)
        add(right, right, h / 3.);
      if (has_left && has_right)
      {
        add(left, right, h / 6.);
        add(right, left, h / 6.);
      }
    }
    for (std::size_t i = 0; i < n_unknowns_; ++i) // L D L^T
      for (std::size_t d = std::min(i, width_of_band) + 1; d-- > 0;)
      {
        const std::size_t j = i - d;
        double sum          = band_[i * stride + d];
        for (std::size_t k = i > width_of_band ? i - width_of_band : 0; k < j; ++k)
          if (j - k <= width_of_band)
            sum -= band_[i * stride + i - k] * band_[j * stride + j - k] * band_[k * stride];
        band_[i * stride + d] = d == 0 ? sum : sum / band_[j * stride];
      }
  }

  void
  SmoothingSpline::solve(std::vector<double> &x) const
  {
    constexpr std::size_t stride = width_of_band + 1;
    for (std::size_t i = 0; i < n_unknowns_; ++i)
      for (std::size_t d = 1; d <= std::min(i, width_of_band); ++d)
        x[i] -= band_[i * stride + d] * x[i - d];
    for (std::size_t i = 0; i < n_unknowns_; ++i)
      x[i] /= band_[i * stride];
    for (std::size_t i = n_unknowns_; i-- > 0;)
      for (std::size_t d = 1; d <= std::min(i, width_of_band); ++d)
        x[i - d] -= band_[i * stride + d] * x[i];
  }

  SplineCurve
  SmoothingSpline::curve(const std::span<const double> values) const
  {
    const std::size_t n = knots_.size();
    std::vector<double> y(values.begin(), values.end()), M(n, 0.);
    if (lambda_ == 0.)
      return {spline_, y, spline_->curvatures(values)};
    const double centre = 0.5 * (knots_.front() + knots_.back()), half = 0.5 * (knots_.back() - knots_.front());
    std::vector<Polynomials> polynomials;
    std::vector<double> trend;
    double first = 0., last = 0.;            // f'' at the ends of what is left
    const auto cubic = [&](const double x) { // with these
      const double d = x - knots_.front();
      return d * d * (0.5 * first + (last - first) / (12. * half) * d);
    };
    if (!is_periodic_)
    {
      const auto begin   = std::ranges::upper_bound(knots_, knots_.front() + width_) - knots_.begin();
      const auto end     = knots_.end() - std::ranges::lower_bound(knots_, knots_.back() - width_);
      const auto n_first = static_cast<std::size_t>(begin), n_last = static_cast<std::size_t>(end);
      // Without many samples in a width the spline through the samples, which keeps cubics, knows the ends better.
      const bool is_narrow            = std::max(n_first, n_last) <= least_polynomials;
      const std::size_t n_polynomials = is_narrow ? least_polynomials : number_of_polynomials(n, 2. * half, width_);
      std::vector<double> x(n);
      for (std::size_t i = 0; i < n; ++i)
      {
        x[i] = (knots_[i] - centre) / half;
        polynomials.emplace_back(x[i], n_polynomials);
      }
      trend = nearest_polynomial(x, values, weights_, n_polynomials);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = 0; j < n_polynomials; ++j)
          y[i] -= trend[j] * polynomials[i].values[j];
      const std::vector<double> unsmoothed = spline_->curvatures(y);
      first = n_first > least_polynomials ? end_curvature(knots_, y, weights_, n_first) : unsmoothed.front();
      last  = n_last > least_polynomials ? end_curvature(reversed(knots_), reversed(y), reversed(weights_), n_last)
                                         : unsmoothed.back();
      for (std::size_t i = 0; i < n; ++i)
        y[i] -= cubic(knots_[i]);
    }
    std::vector<double> unknowns(n_unknowns_, 0.);
    const std::size_t n_rows = is_periodic_ ? n_unknowns_ : n;
    for (std::size_t k = 0; k < n_rows; ++k)
      for (const Entry &entry : row_of_q(k))
        unknowns[place(entry.column)] += entry.value * y[k];
    solve(unknowns);
    for (std::size_t k = 0; k < n_rows; ++k)
      for (const Entry &entry : row_of_q(k))
        y[k] -= lambda_ / weights_[k] * entry.value * unknowns[place(entry.column)];
    for (std::size_t i = 0; i < n_unknowns_; ++i)
      M[is_periodic_ ? i : i + 1] = unknowns[place(i)];
    if (is_periodic_)
    {
      y.back() = y.front();
      M.back() = M.front();
    }
    else
      for (std::size_t i = 0; i < n; ++i)
      {
        y[i] += cubic(knots_[i]);
        M[i] += first + (last - first) * (knots_[i] - knots_.front()) / (2. * half);
        for (std::size_t j = 0; j < trend.size(); ++j)
        {
          y[i] += trend[j] * polynomials[i].values[j];
          M[i] += trend[j] * polynomials[i].curvatures[j] / (half * half);
        }
      }
    return {spline_, std::move(y), std::move(M)};
  }
} // namespace crawler
