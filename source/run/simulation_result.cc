// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/simulation_result.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  std::optional<EntrySensitivity::OfNumber>
  EntrySensitivity::of(const std::string &key) const
  {
    if (key == "displacement")
      return value ? std::optional(OfNumber{key, *value, *error}) : std::nullopt;
    const auto other = std::ranges::find(others, key, &OfNumber::key);
    return other != others.end() ? std::optional(*other) : std::nullopt;
  }

  std::optional<double>
  SimulationResult::standard_deviation(const std::string &key) const
  {
    double variance = 0.;
    for (const EntrySensitivity &one : sensitivities)
    {
      if (one.standard_deviation == 0.)
        continue;
      const auto derivative = one.of(key);
      if (!derivative)
        return std::nullopt;
      variance += std::pow(derivative->value * one.standard_deviation, 2);
    }
    return variance > 0. ? std::optional(std::sqrt(variance)) : std::nullopt;
  }

  void
  SimulationResult::exchange(Archive &archive)
  {
    archive(time);
    archive(process, displacement, error, corrected, errors, size, energy_balance, residuals);
    archive(stretch.min, stretch.max, inversion, gait, gait_efficiency, cycles);
  }
} // namespace crawler
