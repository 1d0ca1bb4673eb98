// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace crawler
{
  /// A column of numbers (what is not known is not a number) or of texts, one for each row.
  struct Column
  {
    std::string name, unit, description;
    std::variant<std::vector<double>, std::vector<std::string>> values;
  };

  /// Columns of one length, each with a name of its own.
  using Table = std::vector<Column>;

  /// The table as comma-separated values (RFC 4180) with a line of names; what is not known is empty.
  std::string
  csv(const Table &table);

  /// Its two parts: the line of names, and the lines of the rows.
  std::string
  csv_names(const Table &table);
  std::string
  csv_rows(const Table &table);

  /**
   * Writes the table as an HDF5 file: group @p group with a dataset for each column, its unit and description as
   * attributes; texts are UTF-8, a number that is not known is NaN. In names "/" becomes ".", since HDF5 keeps "/" for
   * groups; the attribute "name" has the full name. @p attributes are those of the group. Throws FileError.
   */
  void
  write_hdf5(const std::filesystem::path &path,
             const std::string &group,
             const Table &table,
             const std::map<std::string, std::string> &attributes);
} // namespace crawler
