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

  /// A finite number if the whole text is one (a decimal or scientific literal), else nothing.
  std::optional<double>
  to_number(const std::string &text);

  /// The numbers of a list that are separated by commas; nothing if one of them is none.
  std::optional<std::vector<double>>
  to_numbers(const std::string &text);

  /// The shortest text from which to_number() gives back exactly @p value.
  std::string
  to_text(double value);
} // namespace crawler
