// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// Splits a text at separators and trims the parts. Separators within double quotes are skipped, as are those within
  /// parentheses, except semicolons.
  std::vector<std::string>
  split_parts(const std::string &text, char separator);

  /// A call "function(a, b)".
  struct Call
  {
    std::string function;
    std::vector<std::string> arguments; ///< without quotes
  };

  /// Reads a call; nothing unless the whole text is one.
  std::optional<Call>
  read_call(const std::string &text);

  /**
   * Reads VALUES of an axis: linspace(first, last, count), logspace(first exponent, last exponent, count) (powers of
   * ten), or a list of values separated by commas, no two alike if they must be @p distinct. Commas within parentheses,
   * as in max(1, x), do not separate; a value in double quotes may have any characters but quotes. Throws InputError in
   * the name of the entry @p name that has the text; its message also offers @p other_functions, which the caller
   * reads.
   */
  std::vector<std::string>
  parse_values(const std::string &text,
               const std::string &name,
               bool distinct                                   = true,
               const std::vector<std::string> &other_functions = {});

  /// Throws InputError in the name of the entry @p name if two values are alike (compared as numbers where they are
  /// numbers); @p where, say " in column p", follows the value in the sentence.
  void
  require_distinct(const std::vector<std::string> &values, const std::string &name, const std::string &where = "");

  /// Throws InputError, in the name of the entry @p name, unless @p entry is one of @p declarations and all values are
  /// admissible there; file names are relative to @p folder. Leaves the entry at the last value.
  void
  require_valid(const std::string &entry,
                const std::vector<std::string> &values,
                const std::string &name,
                Declarations &declarations,
                const std::filesystem::path &folder = "");
} // namespace crawler
