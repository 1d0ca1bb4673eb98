// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/file_lock.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/log.h>

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// What the commands that compute many runs do not have in common.
  struct StudyKind
  {
    std::string name;                      ///< "sweep", for sentences
    std::vector<std::string> results;      ///< a folder that has one of these files has results to go on with
    std::vector<std::string> free_entries; ///< say how much is computed and not what: they may change meanwhile
  };

  /**
   * The folder of a study of many runs, as rank 0 sees it: a new study begins in it, or an old one goes on, and no
   * other one writes to it meanwhile (study.lock).
   */
  class StudyFolder
  {
  public:
    StudyFolder(StudyKind kind, std::filesystem::path path, const CommandOptions &options, Log &log);

    /// Whether there is a study that goes on (--resume). Otherwise the folder is made, with the parameter file, the
    /// @p effective parameters and the log; one in which a study was killed before it had results is begun anew. Throws
    /// InputError if the folder has something else in it, or a study that is going on; FileError.
    bool
    begin(const std::string &original, const std::string &effective);

    /// Goes on with the study that is there. Throws InputError if it was made with other inputs: what @p changes finds,
    /// in words. Whatever is thrown, by @p changes too, the folder is left as it was.
    void
    resume(const std::function<std::vector<std::string>()> &changes);

    /// Throws FileError if the folder is not the one in which the study began any more.
    void
    require_in_place() const
    {
      lock_->require_in_place();
    }

    /// Nothing is written any more. Throws FileError if the log is not whole.
    void
    leave();

    const StudyKind &
    kind() const
    {
      return kind_;
    }
    const std::filesystem::path &
    path() const
    {
      return path_;
    }
    Log &
    log()
    {
      return log_;
    }

  private:
    enum class State
    {
      empty,    ///< or not there
      begun,    ///< a study was killed before there were results
      computed, ///< there are results
      foreign   ///< something else
    };
    State
    state() const;

    void
    lock();

    /// MPI leaves a file beside a table, FILE-1-NUMBER.lock, where the only process of a study is killed.
    void
    remove_locks_of_mpi() const;

    void
    leaving_if_refused(const std::function<void()> &work);

    const StudyKind kind_;
    const std::filesystem::path path_;
    const CommandOptions &options_;
    Log &log_;
    std::optional<FileLock> lock_;
  };
} // namespace crawler
