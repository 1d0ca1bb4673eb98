// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// Text without blanks at both ends.
  std::string
  trimmed(const std::string &text);

  /// Returns the finite number that is the whole text (a decimal or scientific literal), or nothing.
  std::optional<double>
  to_number(const std::string &text);

  /// Reads a list of numbers separated by commas; nothing if one of them is not a number.
  std::optional<std::vector<double>>
  to_numbers(const std::string &text);

  /// The shortest text from which to_number() gives back exactly @p value.
  std::string
  to_text(double value);
} // namespace crawler
