// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  /// Names, in a sentence, a blank, minus or quote from a web page or word processor that looks like the one of the
  /// keyboard. Empty if the text has none.
  std::string
  foreign_sign(const std::string &text);

  /// Error in a file name that begins with "~/", which only shells understand. Empty if it does not.
  std::string
  home_sign(const std::string &file);

  /// Probable error in a refused value, to be appended to the refusal: a decimal comma, the "~" of a shell, a number
  /// beyond the largest. Empty if there is none of these.
  std::string
  probable_slip(const std::string &value);

  /// Replacement for a command or section of earlier versions, in words. Empty if there was none of this name.
  std::string
  successor_of(const std::string &former);
} // namespace crawler
