// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  /// A blank, a minus or a quote of a web page or a word processor that looks like the one of the keyboard, named in a
  /// sentence. Empty if the text has none.
  std::string
  foreign_sign(const std::string &text);

  /// What is wrong with the name of a file that begins with "~/", which shells only understand. Empty if it does not.
  std::string
  home_sign(const std::string &file);

  /// What is probably wrong in a value that is refused, to be put behind the sentence that refuses it: a decimal comma,
  /// the "~" of a shell, a number beyond the largest. Empty if none of these is in it.
  std::string
  probable_slip(const std::string &value);

  /// What to write instead of a command or section of earlier versions, in words. Empty if there was none of this name.
  std::string
  successor_of(const std::string &former);
} // namespace crawler
