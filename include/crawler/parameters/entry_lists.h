// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <iosfwd>

namespace crawler
{
  class Declarations;

  // Lists of entries, with their defaults, for other programs and for readers.

  /// Prints the present values as a .prm file with every entry explained, in the form of dealii::ParameterHandler.
  void
  print_prm(const Declarations &declarations, std::ostream &out);

  /// Prints JSON: an array of objects with entry, default, expected, unit, documentation.
  void
  print_json(const Declarations &declarations, std::ostream &out);

  /// Prints a JSON schema of an object with an object for each section: types, ranges, choices, defaults, descriptions.
  /// Units are in the keyword "unit".
  void
  print_schema(const Declarations &declarations, std::ostream &out);

  /// Prints a Markdown page.
  void
  print_markdown(const Declarations &declarations, std::ostream &out);
} // namespace crawler
