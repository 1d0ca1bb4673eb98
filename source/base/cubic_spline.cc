// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/cubic_spline.h>

#include <algorithm>
#include <stdexcept>

namespace crawler
{
  CubicSpline::CubicSpline(std::vector<double> knots, const Ends ends)
    : knots_(std::move(knots))
    , ends_(ends)
  {
    if (knots_.size() < 4)
      throw std::logic_error("a cubic spline needs four knots");
    // h_(i-1) M_(i-1) + 2 (h_(i-1) + h_i) M_i + h_i M_(i+1) = 6 ( slope_i - slope_(i-1) ) at the inner knots.
    const std::size_t n = knots_.size(), last = n - 2;
    for (std::size_t i = 0; i + 1 < n; ++i)
      h_.push_back(knots_[i + 1] - knots_[i]);
    std::vector<double> lower(n, 0.);
    factor_.assign(n, 0.);
    pivot_.assign(n, 1.);
    upper_.assign(n, 0.);
    for (std::size_t i = 1; i <= last; ++i)
    {
      lower[i]  = h_[i - 1];
      pivot_[i] = 2. * (h_[i - 1] + h_[i]);
      upper_[i] = h_[i];
    }
    if (ends_ == Ends::not_a_knot)
    {
      // M_0 = M_1 + (M_1 - M_2) h_0/h_1, and likewise at the right end, which leaves the equations to M_1 ... M_(n-2).
      pivot_[1] += h_[0] * (1. + h_[0] / h_[1]);
      upper_[1] -= h_[0] * h_[0] / h_[1];
      pivot_[last] += h_[n - 2] * (1. + h_[n - 2] / h_[n - 3]);
      lower[last] -= h_[n - 2] * h_[n - 2] / h_[n - 3];
    }
    for (std::size_t i = 2; i <= last; ++i)
    {
      factor_[i] = lower[i] / pivot_[i - 1];
      pivot_[i] -= factor_[i] * upper_[i - 1];
    }
    if (ends_ == Ends::periodic)
    {
      // M_0 = M_(n-1) =: X stands in the first and in the last inner equation: M = M(X = 0) - X coupling.
      coupling_.assign(n, 0.);
      coupling_[1] = h_[0];
      for (std::size_t i = 2; i <= last; ++i)
        coupling_[i] = (i == last ? h_[n - 2] : 0.) - factor_[i] * coupling_[i - 1];
      coupling_[last] /= pivot_[last];
      for (std::size_t i = last; i-- > 1;)
        coupling_[i] = (coupling_[i] - upper_[i] * coupling_[i + 1]) / pivot_[i];
      end_pivot_ = 2. * (h_[n - 2] + h_[0]) - h_[n - 2] * coupling_[last] - h_[0] * coupling_[1];
    }
  }

  std::vector<double>
  CubicSpline::curvatures(const std::span<const double> values, const std::size_t n_splines) const
  {
    const std::size_t n = knots_.size(), last = n - 2, m = n_splines;
    std::vector<double> M(n * m, 0.);
    const auto y   = [&](const std::size_t i) { return values.data() + i * m; };
    const auto row = [&](const std::size_t i) { return M.data() + i * m; };
    /// 6 ( slope_i - slope_(i-1) ), with the knots before, at and after the place.
    const auto right_side = [&](const std::size_t before,
                                const std::size_t at,
                                const std::size_t after,
                                const double h_before,
                                const double h_after,
                                double *result) {
      const double *y0 = y(before), *y1 = y(at), *y2 = y(after);
      for (std::size_t c = 0; c < m; ++c)
        result[c] = 6. * ((y2[c] - y1[c]) / h_after - (y1[c] - y0[c]) / h_before);
    };
    for (std::size_t i = 1; i <= last; ++i)
    {
      right_side(i - 1, i, i + 1, h_[i - 1], h_[i], row(i));
      if (i > 1)
        for (std::size_t c = 0; c < m; ++c)
          row(i)[c] -= factor_[i] * row(i - 1)[c];
    }
    for (std::size_t c = 0; c < m; ++c)
      row(last)[c] /= pivot_[last];
    for (std::size_t i = last; i-- > 1;)
      for (std::size_t c = 0; c < m; ++c)
        row(i)[c] = (row(i)[c] - upper_[i] * row(i + 1)[c]) / pivot_[i];
    if (ends_ == Ends::periodic)
    {
      right_side(n - 2, 0, 1, h_[n - 2], h_[0], row(0));
      for (std::size_t c = 0; c < m; ++c)
        row(0)[c] = row(n - 1)[c] = (row(0)[c] - h_[n - 2] * row(last)[c] - h_[0] * row(1)[c]) / end_pivot_;
      for (std::size_t i = 1; i <= last; ++i)
        for (std::size_t c = 0; c < m; ++c)
          row(i)[c] -= coupling_[i] * row(0)[c];
    }
    else
      for (std::size_t c = 0; c < m; ++c)
      {
        row(0)[c]     = row(1)[c] + (row(1)[c] - row(2)[c]) * h_[0] / h_[1];
        row(n - 1)[c] = row(last)[c] + (row(last)[c] - row(last - 1)[c]) * h_[n - 2] / h_[n - 3];
      }
    return M;
  }

  CubicSpline::Place
  CubicSpline::place(const double x) const
  {
    const auto above = std::upper_bound(knots_.begin() + 1, knots_.end() - 1, x);
    const auto i     = static_cast<std::size_t>(above - knots_.begin()) - 1;
    const double h = knots_[i + 1] - knots_[i], a = (knots_[i + 1] - x) / h, b = (x - knots_[i]) / h;
    return {i,
            a,
            b,
            (a * a * a - a) * h * h / 6.,
            (b * b * b - b) * h * h / 6.,
            -1. / h,
            1. / h,
            -(3. * a * a - 1.) * h / 6.,
            (3. * b * b - 1.) * h / 6.};
  }
} // namespace crawler
