// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <string>

namespace crawler
{
  /// The number in six digits, or in all of them if one of the @p others in the sentence differs from it but would look
  /// the same.
  inline std::string
  told_apart(const double value, const std::initializer_list<double> others)
  {
    const std::string text = fmt::format("{:g}", value);
    const bool is_alike    = std::any_of(others.begin(), others.end(), [&](const double other) {
      return other != value && fmt::format("{:g}", other) == text;
    });
    return is_alike ? fmt::format("{}", value) : text;
  }
} // namespace crawler
