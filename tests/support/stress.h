// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "complaint.h"
#include "run_text.h"

#include <crawler/base/grid_samples.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace crawler::test
{
  /// Active stress of a scene, by full names of entries.
  inline std::shared_ptr<const ActiveStress>
  stress_with(const Settings &settings)
  {
    return parameters_with(settings).create_scene().active_stress;
  }

  inline std::vector<double>
  values(const ActiveStress &stress, const std::vector<double> &points, const double t)
  {
    std::vector<double> m(points.size());
    stress.at(points)->values(t, m);
    return m;
  }

  inline std::vector<double>
  rates(const ActiveStress &stress, const std::vector<double> &points, const double t)
  {
    std::vector<double> m(points.size());
    stress.rate_at(points)->values(t, m);
    return m;
  }

  inline double
  largest_difference(const std::vector<double> &a, const std::vector<double> &b)
  {
    double largest = a.size() == b.size() ? 0. : HUGE_VAL;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
      largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
  }

  /// Expects the rate to equal differences of fourth order, at these @p times.
  inline void
  expect_rate(const ActiveStress &stress,
              const double length,
              const std::vector<double> &times,
              const double tolerance,
              const double h = 1e-4)
  {
    const auto points = equal_parts(0., length, 40);
    for (const double t : times)
    {
      const auto m = [&](const double at) { return values(stress, points, at); };
      const auto a = m(t - 2. * h), b = m(t - h), c = m(t + h), d = m(t + 2. * h), rate = rates(stress, points, t);
      for (std::size_t i = 0; i < points.size(); ++i)
        EXPECT_NEAR(rate[i], (8. * (c[i] - b[i]) - (d[i] - a[i])) / (12. * h), tolerance)
          << "s = " << points[i] << ", t = " << t;
    }
  }

  /// Error message for these settings.
  inline std::string
  complaint(const Settings &settings)
  {
    return complaint_of([&]() { parameters_with(settings).create_scene(); });
  }

  inline void
  expect_complaint(const Settings &settings, const std::vector<std::string> &words)
  {
    expect_words(complaint(settings), words);
  }
} // namespace crawler::test
