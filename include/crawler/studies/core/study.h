// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/clock.h>
#include <crawler/base/stop_signal.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/log.h>

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// Common parts of the commands that compute many runs.

  /// Lines of a parameter file that set something.
  std::string
  without_comments(const std::string &parameters);

  /// Provenance of a table, as attributes of the HDF5 file: effective parameters, versions and command.
  std::map<std::string, std::string>
  provenance(const std::string &effective, const std::string &command_line);

  /// Entries that differ between two parameter files (their texts), e.g. "Body/Length was 1, is 2"; without @p others.
  std::vector<std::string>
  differences(const std::string &before, const std::string &after, const std::vector<std::string> &others);

  /// Adds "WHAT was A and is B" for each name whose text differs, unless it @p does_not_count; a missing text is @p
  /// otherwise. @p what is a format of the name.
  void
  add_differences(const std::map<std::string, std::string> &before,
                  const std::map<std::string, std::string> &after,
                  const std::string &what,
                  const std::string &otherwise,
                  std::vector<std::string> &list,
                  const std::function<bool(const std::string &name, const std::string &was, const std::string &is)>
                    &does_not_count = {});

  /// Clock of a run or study, with the causes that end it early: a signal, which from now on ends it in an orderly way,
  /// its time limit, or a file that asks for it.
  class StudyClock
  {
  public:
    /// Limit of the time, if there is one, and the entry that sets it.
    void
    set_limit(const std::optional<double> seconds, std::string in_words)
    {
      limit_          = seconds;
      limit_in_words_ = std::move(in_words);
    }
    void
    set_stop_file(std::filesystem::path file)
    {
      stop_file_ = std::move(file);
    }

    /// Returns true, from then on, once there is a cause on this rank.
    bool
    is_over();

    bool
    has_signal() const
    {
      return signal_.arrived();
    }

    /// Cause of an early end: "signal" (perhaps of another rank), "time_limit" or "stop_file".
    std::string
    reason() const
    {
      return reason_.empty() ? "signal" : reason_;
    }

    /// Cause that all ranks know; empty if the study @p is_whole (collective).
    std::string
    reason(MPI_Comm communicator, const bool is_whole) const
    {
      return is_whole ? "" : signal_.arrived_anywhere(communicator) ? "signal" : "time_limit";
    }

    /// Reason in words, e.g. "stopped by a signal".
    std::string
    in_words(const std::string &reason) const;

    double
    seconds() const
    {
      return now() - begin_;
    }

  private:
    const StopSignal signal_;
    const double begin_ = now();
    std::optional<double> limit_;
    std::string limit_in_words_, reason_;
    std::filesystem::path stop_file_;
    double last_look_ = begin_; ///< for the file
  };

  /// Parts of a study, which the ranks take one after the other.
  struct SharedWork
  {
    unsigned long n_parts;
    unsigned long n_points; ///< missing points, in all parts together
    std::string points;     ///< name of the points: "points"
    /// Returns true if a signal or a time limit ends the work.
    std::function<bool()> interrupted;
    /// Computes part @p number and stores its results. Calls @p see with the number of points stored and the number of
    /// these that did not finish; calls @p stops at every step of a run. Returns false if it was interrupted. Throws
    /// FileError.
    std::function<bool(unsigned long number,
                       const std::function<bool()> &stops,
                       const std::function<void(unsigned long n, unsigned long failed)> &see)>
      compute;
    /// State of the part that rank 0 computes, for the progress display. Empty: parts are short.
    std::function<std::string()> state = {};
    /// Work that rank 0 does for the others whenever it serves them (WorkQueue).
    std::function<void()> besides = {};
  };

  /// Computes all parts; returns false if some rank was interrupted (collective). A file that one rank cannot write
  /// ends the work of all: FileError on all ranks.
  bool
  share_work(MPI_Comm communicator, const SharedWork &work, Log &log);

  /// Throws FileError on all ranks for a problem with the files of any rank (empty: none) (collective).
  void
  throw_on_all_ranks(MPI_Comm communicator, const std::string &problem);

  /// Logs the options behind "--".
  void
  announce_petsc_options(const CommandOptions &options, Log &log);

  /// Warns of PETSc options that no rank has read by the end: they are most likely misspelt (collective).
  void
  warn_of_unused_petsc_options(MPI_Comm communicator, const CommandOptions &options, Log &log);
} // namespace crawler
