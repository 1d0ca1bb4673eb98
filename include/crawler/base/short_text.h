// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <string>

namespace crawler
{
  /// Largest number of bytes of a UTF-8 @p text, at most @p width, that are whole characters.
  std::size_t
  whole_characters(const std::string &text, std::size_t width);

  /// The text, cut and ended with dots if it is longer than @p width.
  std::string
  shortened(const std::string &text, std::size_t width);
} // namespace crawler
