// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace crawler
{
  /// Mistakes of one kind in a file: the sentence about the first, and the rows of the others.
  class Mistakes
  {
  public:
    /// Notes a row; @p sentence says what is wrong with it.
    void
    note(std::size_t row, const std::function<std::string()> &sentence);
    /// Throws InputError for @p entry if there are any.
    void
    report(const std::string &entry) const;

  private:
    std::string sentence_; ///< about the first
    std::size_t first_ = 0;
    std::set<std::size_t> others_;
  };

  /// Columns of finite numbers.
  struct CsvNumbers
  {
    std::vector<std::vector<double>> columns;
    std::vector<std::size_t> rows; ///< their numbers in the file, the header being row 1
  };

  /**
   * Reads a CSV file whose header is @p names. A byte order mark, carriage returns, blanks and empty rows do not
   * matter. Throws InputError for @p entry if something is not a number; messages call the file @p file.
   */
  CsvNumbers
  csv_numbers(std::string_view text,
              const std::vector<std::string> &names,
              const std::string &file,
              const std::string &entry);

  /// Text of a file with numbers; @p expected says in messages what belongs there. Throws InputError for @p entry if it
  /// is empty or cannot be read.
  std::string
  read_table_text(const std::string &file, const std::string &expected, const std::string &entry);

  /// Reads the text of @p file and its numbers.
  CsvNumbers
  read_csv_numbers(const std::string &file,
                   const std::vector<std::string> &names,
                   const std::string &expected,
                   const std::string &entry);
} // namespace crawler
