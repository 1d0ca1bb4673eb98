// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

namespace crawler
{
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
      throw InputError(fmt::format(message, std::forward<Arguments>(arguments)...), entry);
    }
  };
} // namespace crawler
