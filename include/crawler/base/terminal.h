// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Columns of the terminal that standard output goes to; 0 if that is none, or one that cannot move its cursor
  /// (TERM = dumb).
  unsigned int
  terminal_width();

  /// Whether the user's language settings (LC_ALL, LC_CTYPE, LANG) say that texts are in UTF-8.
  bool
  terminal_has_utf8();
} // namespace crawler
