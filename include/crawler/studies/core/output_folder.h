// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>

namespace crawler
{
  /// The folder of a run: --output, or "output-NAME" for NAME.prm, in the present folder.
  std::filesystem::path
  output_folder(const std::string &option, const std::string &parameter_file);

  /// Throws InputError if the folder has something in it that must not be overwritten, FileError if it is not a folder.
  void
  require_usable(const std::filesystem::path &folder, bool overwrite);

  /// Locked (base/file_lock.h) as long as a study of many runs writes to the folder.
  extern const std::string study_lock_name;

  /// The page that `crawler report` makes.
  extern const std::string report_name;

  /// Throws InputError if a study of another process writes to the folder.
  void
  require_no_study(const std::filesystem::path &folder);

  /// Makes the folder, without the results of an earlier run (only files that this program writes are removed).
  void
  prepare(const std::filesystem::path &folder);

  /// Removes what a run has written while it went on: the fields and the statistics.
  void
  remove_fields(const std::filesystem::path &folder);
} // namespace crawler
