// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/base/grid_table.h>

#include <fmt/format.h>

#include <string>
#include <utility>

namespace crawler
{
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

  /// Reads the samples of a grid from an HDF5 file (read_grid_table()). Throws InputError.
  GridTable
  read_hdf5_grid_table(const GridTableSource &source);
} // namespace crawler
