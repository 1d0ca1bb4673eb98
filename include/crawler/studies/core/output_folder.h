// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/file_lock.h>

#include <filesystem>
#include <optional>
#include <string>

namespace crawler
{
  /// The folder of a run: --output, or "output-NAME" for NAME.prm, in the present folder.
  std::filesystem::path
  output_folder(const std::string &option, const std::string &parameter_file);

  /// Throws InputError if the folder has something in it that must not be overwritten, FileError if it is not a folder
  /// or has links where folders of the program's own are expected.
  void
  require_usable(const std::filesystem::path &folder, bool overwrite);

  /// Locked (base/file_lock.h) as long as a run or study writes to the folder.
  extern const std::string study_lock_name;

  /// The page that `crawler report` makes.
  extern const std::string report_name;

  /// Keeps others from writing to a folder as long as it lives.
  class FolderLock
  {
  public:
    /// Makes the folder. Throws InputError if another process writes to it, and as require_usable() does.
    FolderLock(const std::filesystem::path &folder, bool overwrite);
    ~FolderLock();
    FolderLock(const FolderLock &) = delete;

    /// Throws FileError if the folder is not the one that was locked any more.
    void
    require_in_place() const
    {
      lock_->require_in_place();
    }

  private:
    std::optional<FileLock> lock_;
  };

  /// Makes the folder, without the results of an earlier run (only files that this program writes are removed).
  void
  prepare(const std::filesystem::path &folder);

  /// Removes what a run has written while it went on: the fields and the statistics.
  void
  remove_fields(const std::filesystem::path &folder);
} // namespace crawler
