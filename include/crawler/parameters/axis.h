// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// The values that one entry of the parameter file takes in turn: an axis of a study.
  struct Axis
  {
    std::string entry;               ///< "Section/Entry"
    std::vector<std::string> values; ///< as they stand in a parameter file, no two alike
  };

  /// Reads VALUES as parse_axis() does, as they stand in a parameter file, no two alike if they must be @p distinct.
  /// Throws InputError in the name of the entry @p name.
  std::vector<std::string>
  parse_values(const std::string &text, const std::string &name, bool distinct = true);

  /// What parse_axis() reads, in words.
  extern const std::string axis_syntax;

  /**
   * Reads "Section/Entry : VALUES", where VALUES is linspace(first, last, count), logspace(first exponent, last
   * exponent, count) (powers of ten), or a list of values separated by commas. Throws InputError in the name of the
   * entry @p name in which the text stands.
   */
  Axis
  parse_axis(const std::string &text, const std::string &name);

  /// Throws InputError, in the name of the entry @p name, unless the axis is that of an entry in @p declarations and
  /// all its values are admissible there. Leaves the entry at the last value.
  void
  require_valid(const Axis &axis, const std::string &name, Declarations &declarations);

  /// The values as numbers. Throws InputError if one is something else.
  std::vector<double>
  numbers_of(const Axis &axis, const std::string &name);
} // namespace crawler
