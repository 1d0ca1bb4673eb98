// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <iosfwd>

namespace crawler
{
  class Declarations;

  // The list of entries, with their defaults, for other programs and for readers.

  /// JSON: an array of objects with entry, default, expected, unit, documentation.
  void
  print_json(const Declarations &declarations, std::ostream &out);

  /// A JSON schema of an object with an object for each section: types, ranges, choices, defaults, descriptions. Units
  /// are in the keyword "unit".
  void
  print_schema(const Declarations &declarations, std::ostream &out);

  /// A Markdown page of the entries.
  void
  print_markdown(const Declarations &declarations, std::ostream &out);
} // namespace crawler
