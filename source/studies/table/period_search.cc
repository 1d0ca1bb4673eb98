// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/smoothing_spline.h>
#include <crawler/studies/table/period_search.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crawler
{
  std::optional<double>
  find_period(const Samples &samples)
  {
    constexpr std::size_t most_steps = 512, least_lag = 4;
    constexpr double longest = 0.8;  // part of the duration
    constexpr double alike   = 0.25; // mean square difference over that of samples that have nothing in common
    constexpr double as_good = 1.5, slack = 1e-4;
    const double begin = samples.t.front(), duration = samples.t.back() - begin;
    std::vector<SplineCurve> curves;
    const SmoothingSpline spline(samples.t, 0.);
    for (std::size_t i = 0; i < samples.s.size(); ++i)
      curves.push_back(spline.curve(samples.over_time(i)));
    const std::size_t n = std::min(4 * (samples.t.size() - 1), most_steps);
    const double step   = duration / static_cast<double>(n);
    double variance     = 0.;
    for (const SplineCurve &curve : curves)
    {
      double sum = 0., square = 0.;
      for (std::size_t j = 0; j <= n; ++j)
      {
        const double y = curve.value(begin + step * static_cast<double>(j));
        sum += y;
        square += y * y;
      }
      variance += square / static_cast<double>(n + 1) - std::pow(sum / static_cast<double>(n + 1), 2);
    }
    if (!(variance > 0.))
      return std::nullopt;
    const auto difference = [&](const double lag) {
      const auto m = static_cast<std::size_t>(std::max(2., std::floor((duration - lag) / step)));
      double sum   = 0.;
      for (const SplineCurve &curve : curves)
        for (std::size_t j = 0; j <= m; ++j)
        {
          const double t = begin + (duration - lag) * static_cast<double>(j) / static_cast<double>(m);
          sum += std::pow(curve.value(t + lag) - curve.value(t), 2);
        }
      return sum / (2. * variance * static_cast<double>(m + 1));
    };
    std::vector<double> differences;
    for (std::size_t j = 0; static_cast<double>(j) <= longest * static_cast<double>(n) + 1.; ++j)
      differences.push_back(difference(step * static_cast<double>(std::min(j, n))));
    const auto is_minimum = [&](const std::size_t j) {
      return differences[j] <= differences[j - 1] && differences[j] < differences[j + 1];
    };
    double least = HUGE_VAL;
    for (std::size_t j = least_lag; j + 1 < differences.size(); ++j)
      if (is_minimum(j))
        least = std::min(least, differences[j]);
    if (!(least < alike))
      return std::nullopt;
    for (std::size_t j = least_lag; j + 1 < differences.size(); ++j)
    {
      if (!is_minimum(j))
        continue;
      double from = step * static_cast<double>(j - 1), to = step * static_cast<double>(j + 1);
      constexpr double golden = 1. / std::numbers::phi;
      for (unsigned int k = 0; k < 50; ++k)
      {
        const double a = to - golden * (to - from), b = from + golden * (to - from);
        const bool is_left    = difference(a) < difference(b);
        (is_left ? to : from) = is_left ? b : a;
      }
      if (difference(0.5 * (from + to)) <= as_good * least + slack)
        return 0.5 * (from + to);
    }
    return std::nullopt;
  }
} // namespace crawler
