// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/file_lock.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

namespace crawler
{
  /// Folder of a run: --output, or "output-NAME" for NAME.prm, in the current folder.
  std::filesystem::path
  output_folder(const std::string &option, const std::string &parameter_file);

  /// Throws InputError if the folder contains files that must not be overwritten, FileError if it is not a folder or
  /// has links where folders of the program's own are expected.
  void
  require_usable(const std::filesystem::path &folder, bool overwrite);

  /// Name of the file that is locked (base/file_lock.h) while a run or study writes to the folder.
  inline const std::string study_lock_name = "study.lock";

  /// Page that `crawler report` makes.
  inline const std::string report_name = "report.html";

  /// Makes a folder. Throws FileError.
  void
  make_folder(const std::filesystem::path &folder);

  /// Returns true if the folder has nothing but what a run or study leaves that is killed while it begins, and files of
  /// these names too.
  bool
  has_just_begun(const std::filesystem::path &folder, std::set<std::string> others);

  /// Throws InputError if there are @p changes, in words, of what a run or study (@p kind) was made with.
  void
  require_unchanged(const std::string &kind,
                    const std::filesystem::path &folder,
                    const std::vector<std::string> &changes,
                    const std::vector<std::string> &free_entries);

  /// Keeps other processes from writing to a folder during its lifetime.
  class FolderLock
  {
  public:
    /// Makes the folder. Throws InputError if another process writes to it, and as require_usable() does.
    FolderLock(const std::filesystem::path &folder, bool overwrite);
    ~FolderLock();
    FolderLock(const FolderLock &) = delete;

    /// Throws FileError if the folder is no longer the one that was locked.
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

  /// Removes the folder of a run, but not files that are not the program's.
  void
  remove_run(const std::filesystem::path &folder);

  /// Removes files that a run writes as it proceeds: the fields and the statistics.
  void
  remove_fields(const std::filesystem::path &folder);
} // namespace crawler
