// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/entry_info.h>

#include <fmt/format.h>

#include <cmath>

namespace crawler
{
  bool
  Range::contains(const double value) const
  {
    return std::isfinite(value) && (value > lower || (lower_included && value == lower)) &&
           (value < upper || (upper_included && value == upper));
  }

  std::string
  Range::in_words() const
  {
    const bool has_lower = std::isfinite(lower), has_upper = std::isfinite(upper);
    if (!has_lower && !has_upper)
      return "a number";
    if (has_lower && !has_upper)
      return lower == 0 ? (lower_included ? "a number that is not negative" : "a positive number")
                        : fmt::format("a number {} {}", lower_included ? "from" : "above", lower);
    return fmt::format(
      "a number {} {} {} {}", lower_included ? "from" : "above", lower, upper_included ? "to" : "and below", upper);
  }
} // namespace crawler
