// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// Ends of @p n equal parts of [@p from, @p to], n + 1 numbers.
  inline std::vector<double>
  equal_parts(const double from, const double to, const unsigned int n)
  {
    std::vector<double> ends;
    for (unsigned int i = 0; i < n; ++i)
      ends.push_back(from + (to - from) * i / n);
    ends.push_back(to);
    return ends;
  }

  /// Samples of a function at all points of a grid over s and t.
  struct GridTable
  {
    std::vector<double> s, t;   ///< increasing
    std::vector<double> values; ///< [t][s]
  };

  /// Differences of s or t below this part of their range are round-off.
  inline constexpr double grid_round_off = 1e-12;

  /// Origin of a table, for messages.
  struct GridTableSource
  {
    std::string file, name, entry;

    template <typename... Arguments>
    [[noreturn]] void
    refuse(fmt::format_string<Arguments...> message, Arguments &&...arguments) const
    {
      crawler::refuse(entry, message, std::forward<Arguments>(arguments)...);
    }
  };
} // namespace crawler
