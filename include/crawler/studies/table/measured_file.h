// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace crawler
{
  /// A sample that is missing.
  inline constexpr double gap = std::numeric_limits<double>::quiet_NaN();

  /// The text of a table of numbers as instruments and spreadsheets write it. What is missing is not a number.
  struct MeasuredFile
  {
    std::string name;                        ///< of the file, for messages
    std::vector<std::string> columns, units; ///< their names and units, which may be empty
    std::vector<std::vector<double>> values; ///< [row][column]
    std::vector<std::size_t> lines;          ///< the number of each row in the file, from 1
    std::vector<std::string> words;          ///< what was found, for the report
  };

  /**
   * Reads @p text: columns between semicolons, tabs, commas or blanks; decimals with a point or, unless commas separate
   * the columns, with a comma; comments that begin with #, % or //; titles above the line of names; units behind the
   * names ("t [s]", "t (s)", "t / s") or in a line of their own. Empty cells, NaN, NA and - are gaps. Throws InputError
   * with the number of the line.
   */
  MeasuredFile
  read_measured_file(const std::string &text, const std::string &name);
} // namespace crawler
