// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <string>

namespace crawler
{
  /// The text with 0 and nan in place of -0, -0.000 and -nan, which mean the same to a reader; columns keep their
  /// places.
  std::string
  with_plain_numbers(std::string text);

  /// The text with every control character spelled out (\\x1b), so that foreign texts (file names, formulas) cannot
  /// steer a terminal; ends of lines and tabs stay if @p keep_lines.
  std::string
  without_controls(const std::string &text, bool keep_lines = true);

  /// Largest number of bytes of a UTF-8 @p text, at most @p width, that are whole characters.
  std::size_t
  whole_characters(const std::string &text, std::size_t width);

  /// The text, cut and ended with dots if it is longer than @p width.
  std::string
  shortened(const std::string &text, std::size_t width);

  /// The text with long quotations cut in the middle.
  std::string
  with_short_quotes(const std::string &text);

  /// Number with its noun: "1 cell", "2 cells".
  std::string
  counted(unsigned long number, const std::string &noun);
} // namespace crawler
