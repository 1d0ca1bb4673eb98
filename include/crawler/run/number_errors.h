// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace crawler
{
  /// Error bars of the numbers of a summary besides the displacement; not a number where unknown.
  struct NumberErrors
  {
    static constexpr std::size_t n = 16;

    /// Their keys in summary.json, dots for nesting.
    static const std::array<const char *, n> &
    keys();

    std::array<double, n> values;

    NumberErrors()
    {
      values.fill(std::numeric_limits<double>::quiet_NaN());
    }
  };
} // namespace crawler
