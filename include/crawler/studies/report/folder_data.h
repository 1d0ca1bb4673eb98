// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/report/packed.h>

#include <filesystem>
#include <string>

namespace crawler
{
  /// What a page needs to know of the files in a folder. What is not there is null. All throw FileError if a file
  /// cannot be read, InputError if one is damaged.

  /// summary.json.
  Json
  summary_data(const std::filesystem::path &folder);

  /// The entries that are not at their defaults (entry, value, default, unit, meaning), and the files
  /// themselves, from parameters.prm and original.prm.
  Json
  parameter_data(const std::filesystem::path &folder);

  /// What the user calls the units: {length, time, force, energy}.
  Json
  unit_data(const std::filesystem::path &folder);

  /// A run, which is called @p title: summary, body, statistics, kymograph (of at most @p most_rows times), ground,
  /// sensitivities along the body.
  Json
  run_data(const std::filesystem::path &folder, const std::string &title, std::size_t most_rows);

  /**
   * A table of a RowFile: its columns (those whose meaning begins with "axis" or is "variable" are what was varied),
   * and which of them were left out because they would make the page too large; of very many rows some, evenly.
   */
  Json
  table_data(const std::filesystem::path &file, const std::string &group);
} // namespace crawler
