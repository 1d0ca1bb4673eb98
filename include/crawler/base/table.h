// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <variant>
#include <vector>

namespace crawler
{
  /// A column of numbers (unknown ones are NaN) or of texts, one for each row.
  struct Column
  {
    std::string name, unit, description;
    std::variant<std::vector<double>, std::vector<std::string>> values;
  };

  /// Columns of one length, each with a name of its own.
  using Table = std::vector<Column>;

  /// The table as comma-separated values (RFC 4180) with a line of names; unknown numbers are empty.
  std::string
  csv(const Table &table);

  /// The two parts of csv(): the line of names, and the lines of the rows.
  std::string
  csv_names(const Table &table);
  std::string
  csv_rows(const Table &table);
} // namespace crawler
