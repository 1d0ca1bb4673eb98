// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/known_stress.h>

#include <algorithm>

namespace crawler
{
  /// No actuation: m = 0. The simplest generator.
  class NoActiveStress : public KnownStress
  {
  public:
    static constexpr const char *description = "no actuation, m = 0";

    std::optional<Bounds>
    bounds(const Box &) const override
    {
      return Bounds{0., 0.};
    }

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &, bool) const override
    {
      return stress_at_points([](double, const std::span<double> m) { std::fill(m.begin(), m.end(), 0.); });
    }
  };
} // namespace crawler
