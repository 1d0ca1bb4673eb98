// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace crawler::test
{
  /// This part of the values is below it; not a number if there are none.
  inline double
  quantile(std::vector<double> values, const double part)
  {
    std::sort(values.begin(), values.end());
    const auto place = static_cast<std::size_t>(part * static_cast<double>(values.size()));
    return values.empty() ? NAN : values[std::min(values.size() - 1, place)];
  }

  /// Numbers that are the same everywhere (distributions of the standard library are not).
  class Random
  {
  public:
    explicit Random(const unsigned int seed)
      : engine_(seed)
    {
    }

    double
    uniform(const double lower, const double upper)
    {
      return lower + (upper - lower) * static_cast<double>(engine_() >> 11U) * 0x1.0p-53;
    }
    double
    log_uniform(const double lower, const double upper)
    {
      return lower * std::exp(uniform(0., std::log(upper / lower)));
    }
    unsigned int
    whole(const unsigned int lower, const unsigned int upper)
    {
      return lower + static_cast<unsigned int>(uniform(0., 1.) * (upper - lower + 1));
    }
    bool
    chance(const double probability)
    {
      return uniform(0., 1.) < probability;
    }

  private:
    std::mt19937_64 engine_;
  };
} // namespace crawler::test
