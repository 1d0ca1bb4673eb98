// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace crawler
{
  /// Error bounds of the numbers of a summary besides the displacement; not a number where unknown.
  struct NumberErrors
  {
    static constexpr std::size_t n = 17;

    /// Bounds in the order of entries_with_errors() (result_table.h).
    std::array<double, n> values;

    NumberErrors()
    {
      values.fill(std::numeric_limits<double>::quiet_NaN());
    }

    void
    exchange(auto &archive)
    {
      archive(values);
    }
  };
} // namespace crawler
