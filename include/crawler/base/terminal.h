// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Columns of the terminal that standard output goes to; 0 if it is no terminal, or cannot move its cursor (TERM =
  /// dumb).
  unsigned int
  terminal_width();

  /// True if the user's locale (LC_ALL, LC_CTYPE, LANG) is in UTF-8.
  bool
  terminal_has_utf8();
} // namespace crawler
