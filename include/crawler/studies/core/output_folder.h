// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/file_lock.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/log.h>

#include <filesystem>
#include <functional>
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

  /// Keeps other processes from writing to a folder.
  class FolderLock : public FileLock
  {
  public:
    /// Makes the folder. Throws InputError if another process writes to it, and does not end within seconds.
    FolderLock(const std::filesystem::path &folder, Log &log);
  };

  /// Status that the summary.json in a folder has; empty if there is none.
  std::string
  status_in(const std::filesystem::path &folder);

  /// Returns true if the folder is empty except perhaps for a lock.
  bool
  is_free(const std::filesystem::path &folder);

  /// Removes the results of an earlier run from the folder (only files that this program writes).
  void
  prepare(const std::filesystem::path &folder);

  /// Removes what a study keeps of its runs in @p folder: folders whose names match the regular expression @p names,
  /// and files if these have an extension; not the files of others in them. Removes @p folder if it is empty then.
  void
  remove_runs(const std::filesystem::path &folder, const std::string &names);

  /// Removes files that a run writes as it proceeds: the fields and the statistics.
  void
  remove_fields(const std::filesystem::path &folder);

  /// Differences between the commands that compute many runs.
  struct StudyKind
  {
    std::string name;                      ///< "sweep", for sentences
    std::string results;                   ///< file that makes a folder one with results, to be resumed
    std::vector<std::string> free_entries; ///< entries for the amount of computation: they may change meanwhile
  };

  /**
   * Folder of a study of many runs, as seen by rank 0: a new study begins in it, or an old one is resumed, and no other
   * one writes to it meanwhile (study.lock).
   */
  class StudyFolder
  {
  public:
    StudyFolder(StudyKind its_kind, const CommandOptions &its_options, Log &its_log);

    /// Returns true if a study is to be resumed (--resume). Otherwise makes the folder, with the parameter file, the @p
    /// effective parameters and the log; a study that was killed before it had results is begun anew. Throws InputError
    /// if the folder contains anything else, or a study in progress; FileError.
    bool
    begin(const std::string &original, const std::string &effective);

    /// Resumes the study in the folder. Throws InputError if it was made with other inputs: the differences that @p
    /// changes finds, in words. If anything is thrown, by @p changes too, the folder is left as it was.
    void
    resume(const std::function<std::vector<std::string>()> &changes);

    /// Throws FileError if the folder is no longer the one in which the study began.
    void
    require_in_place() const
    {
      lock_->require_in_place();
    }

    /// Ends writing. Throws FileError if the log is not whole.
    void
    leave();

    const StudyKind kind;
    const CommandOptions &options;
    const std::filesystem::path path; ///< output_folder()
    Log &log;

  private:
    bool
    has_results() const;
    /// True for anything else than a study, or what one leaves that is killed before it has results.
    bool
    is_foreign() const;

    void
    leaving_if_refused(const std::function<void()> &work);

    std::optional<FolderLock> lock_;
  };
} // namespace crawler
