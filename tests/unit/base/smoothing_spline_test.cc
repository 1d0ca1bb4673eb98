// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Smoothing splines against known solutions.
#include <crawler/base/smoothing_spline.h>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace crawler;

namespace
{
  constexpr double pi = std::numbers::pi;

  std::vector<double>
  at(const std::vector<double> &x, const auto &f)
  {
    std::vector<double> y;
    for (const double place : x)
      y.push_back(f(place));
    return y;
  }

  std::vector<double>
  equal(const std::size_t n, const double from, const double to)
  {
    std::vector<double> x;
    for (std::size_t i = 0; i <= n; ++i)
      x.push_back(from + (to - from) * static_cast<double>(i) / static_cast<double>(n));
    return x;
  }
} // namespace

/// A wave stays a wave, times 1/(1 + lambda mu) with the discrete eigenvalue mu of the fourth derivative.
TEST(SmoothingSpline, damps_periodic_waves_as_known)
{
  for (const std::size_t n : {5u, 6u, 11u, 24u})
    for (const unsigned int k : {0u, 1u, 2u})
    {
      const double h = 1. / static_cast<double>(n), width = 0.7, q = 2. * pi * k;
      const std::vector<double> x = equal(n, 0., 1.), y = at(x, [&](const double s) { return std::cos(q * s + 0.3); });
      const SplineCurve curve = SmoothingSpline(x, width, CubicSpline::Ends::periodic).curve(y);
      const double lambda     = std::pow(width / (2. * pi), 4) / h;
      const double second = (2. * std::cos(q * h) - 2.) / h, mass = h * (4. + 2. * std::cos(q * h)) / 6.;
      const double part = 1. / (1. + lambda * second * second / mass);
      for (std::size_t i = 0; i <= n; ++i)
      {
        EXPECT_NEAR(curve.values()[i], part * y[i], 1e-12) << n << " samples, wave " << k;
        EXPECT_NEAR(curve.curvatures()[i], part * y[i] * second / mass, 1e-9) << n << " samples, wave " << k;
      }
    }
}

TEST(SmoothingSpline, halves_waves_as_long_as_the_width)
{
  const std::vector<double> x = equal(400, 0., 1.),
                            y = at(x, [](const double s) { return std::sin(2. * pi * 4. * s); });
  const SplineCurve curve     = SmoothingSpline(x, 0.25, CubicSpline::Ends::periodic).curve(y);
  EXPECT_NEAR(curve.value(1. / 16.), 0.5, 1e-4);
}

/// Also between uneven knots, with weights.
TEST(SmoothingSpline, keeps_cubic_polynomials)
{
  const std::vector<double> x = {1., 1.2, 1.9, 2., 3.3, 4., 4.4, 6.};
  const auto f                = [](const double s) { return 2. - s + 0.5 * s * s - 0.3 * s * s * s; };
  for (const double width : {0., 0.1, 1., 10.})
  {
    const SplineCurve curve =
      SmoothingSpline(x, width, CubicSpline::Ends::not_a_knot, {1., 2., 1., 3., 1., 1., 0.5, 1.}).curve(at(x, f));
    for (const double s : {1., 1.5, 3., 5.9})
    {
      EXPECT_NEAR(curve.value(s), f(s), 1e-10) << width;
      EXPECT_NEAR(curve.derivative(s), -1. + s - 0.9 * s * s, 1e-9) << width;
    }
  }
}

/// Nothing makes the functional smaller.
TEST(SmoothingSpline, is_the_minimum)
{
  const std::vector<double> x = {0., 0.3, 0.5, 1.1, 1.2, 1.9, 2.4}, y = {0., 1., -1., 2., 0.5, 0., 1.},
                            w = {1., 2., 1., 1., 0.5, 1., 3.};
  const double width          = 2.;
  const double lambda         = std::pow(width / (2. * pi), 4) / (2.4 / 6.);
  const SplineCurve curve     = SmoothingSpline(x, width, CubicSpline::Ends::not_a_knot, w).curve(y);
  // First variation for v of which the cubic part is taken away: sum w (f - y) v + lambda int (f - p)'' v'' = 0. The
  // sum over polynomials vanishes for the nearest cubic, since the residual is orthogonal to 1 and x at least.
  for (unsigned int power = 0; power < 2; ++power)
  {
    double sum = 0.;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += w[i] * (curve.values()[i] - y[i]) * std::pow(x[i], power);
    EXPECT_NEAR(sum, 0., 1e-12);
  }
  double change = 0.;
  for (std::size_t i = 0; i < x.size(); ++i)
    change += std::abs(curve.values()[i] - y[i]);
  EXPECT_GT(change, 0.1 * lambda);
}

/// At the ends, too, waves that are three times as long as the width keep their slope, and a width of nearly nothing
/// does nothing.
TEST(SmoothingSpline, keeps_slopes_at_the_ends)
{
  for (const unsigned int n : {10u, 19u, 40u})
    for (const double width : {1e-3, 0.3})
    {
      const std::vector<double> x = equal(n, 0., 0.9);
      double largest              = 0.;
      for (double phase = 0.; phase < 1.; phase += 1. / 16.)
      {
        const auto curve =
          SmoothingSpline(x, width).curve(at(x, [&](const double s) { return std::sin(2. * pi * (s + phase)); }));
        for (const double s : {0., 0.9})
          largest = std::max(largest, std::abs(curve.derivative(s) / (2. * pi) - std::cos(2. * pi * (s + phase))));
      }
      EXPECT_LT(largest, n == 10 ? 0.1 : width < 0.1 ? 0.01 : 0.08) << n << " knots, width " << width;
    }
}

/// What smoothing takes away from a smooth function is of order width^4 far from the ends.
TEST(SmoothingSpline, has_a_bias_of_fourth_order)
{
  const std::vector<double> x = equal(800, 0., 1.);
  const auto f                = [](const double s) { return std::sin(5. * s); };
  const auto bias             = [&](const double width) {
    return std::abs(SmoothingSpline(x, width).curve(at(x, f)).value(0.5) - f(0.5));
  };
  EXPECT_NEAR(std::log2(bias(0.1) / bias(0.05)), 4., 0.1);
}
