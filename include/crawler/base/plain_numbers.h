// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  /// The text with 0 and nan instead of the numbers -0, -0.000 and -nan, which mean the same to a reader; columns stay
  /// where they are.
  std::string
  with_plain_numbers(std::string text);

  /// "1 cell", "2 cells".
  std::string
  counted(unsigned long number, const std::string &noun);
} // namespace crawler
