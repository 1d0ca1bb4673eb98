// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/file_lock.h>
#include <crawler/base/row_file.h>
#include <crawler/studies/core/log.h>
#include <crawler/studies/run/run.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// The group of results.h5 that is the table.
  extern const std::string sweep_group;

  /// The folder of a sweep, as rank 0 sees it: a new sweep begins in it, or an old one goes on, and no other one writes
  /// to it meanwhile (sweep.lock).
  class SweepFolder
  {
  public:
    SweepFolder(std::filesystem::path path, const CommandOptions &options, Log &log);

    /// Makes the files of a new sweep, or, with --resume, looks for one that is the same. A folder in which a sweep was
    /// killed before there was a table is begun anew. Returns which points have a row. Throws InputError if the folder
    /// has something else in it, a sweep with other parameters or input files, or one that is going on; FileError.
    std::vector<bool>
    begin_or_resume(const ParameterFile &file, const SweepPoints &points, const std::vector<RowFile::Column> &columns);

    /// Nothing is written any more.
    void
    leave();

  private:
    enum class State
    {
      empty,    ///< or not there
      begun,    ///< a sweep was killed before there was a table
      computed, ///< there is a table
      foreign   ///< something else
    };
    State
    state() const;

    void
    lock();

    std::vector<bool>
    rows_that_are_there(const SweepPoints &points, const std::vector<RowFile::Column> &columns);

    const std::filesystem::path path_;
    const CommandOptions &options_;
    Log &log_;
    std::optional<FileLock> lock_;
  };
} // namespace crawler
