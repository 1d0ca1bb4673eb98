// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/cubic_spline.h>

#include <algorithm>
#include <stdexcept>

namespace crawler
{
  CubicSpline::CubicSpline(std::vector<double> knots)
    : knots_(std::move(knots))
  {
    if (knots_.size() < 4)
      throw std::logic_error("a cubic spline needs four knots");
  }

  std::vector<double>
  CubicSpline::curvatures(const std::span<const double> y) const
  {
    // h_(i-1) M_(i-1) + 2 (h_(i-1) + h_i) M_i + h_i M_(i+1) = 6 ( slope_i - slope_(i-1) ) at the inner knots; by
    // not-a-knot M_0 = M_1 + (M_1 - M_2) h_0/h_1, and likewise at the right end, which leaves them to M_1 ... M_(n-2).
    const std::size_t n = knots_.size(), last = n - 2;
    std::vector<double> h(n - 1), slope(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i)
    {
      h[i]     = knots_[i + 1] - knots_[i];
      slope[i] = (y[i + 1] - y[i]) / h[i];
    }
    std::vector<double> lower(n, 0.), diagonal(n, 0.), upper(n, 0.), M(n, 0.);
    for (std::size_t i = 1; i <= last; ++i)
    {
      lower[i]    = h[i - 1];
      diagonal[i] = 2. * (h[i - 1] + h[i]);
      upper[i]    = h[i];
      M[i]        = 6. * (slope[i] - slope[i - 1]);
    }
    diagonal[1] += h[0] * (1. + h[0] / h[1]);
    upper[1] -= h[0] * h[0] / h[1];
    diagonal[last] += h[n - 2] * (1. + h[n - 2] / h[n - 3]);
    lower[last] -= h[n - 2] * h[n - 2] / h[n - 3];
    for (std::size_t i = 2; i <= last; ++i)
    {
      const double factor = lower[i] / diagonal[i - 1];
      diagonal[i] -= factor * upper[i - 1];
      M[i] -= factor * M[i - 1];
    }
    M[last] /= diagonal[last];
    for (std::size_t i = last; i-- > 1;)
      M[i] = (M[i] - upper[i] * M[i + 1]) / diagonal[i];
    M[0]     = M[1] + (M[1] - M[2]) * h[0] / h[1];
    M[n - 1] = M[last] + (M[last] - M[last - 1]) * h[n - 2] / h[n - 3];
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
