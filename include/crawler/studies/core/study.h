// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/stop_signal.h>
#include <crawler/studies/core/log.h>

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// What the commands have in common that compute many runs.

  /// A number without common divisor with @p n, near the golden section of it: its multiples modulo n visit all of n
  /// parts, spread out from the beginning. So the time left is known early, and a study that is stopped is a coarse
  /// picture of everything.
  unsigned long
  golden_stride(unsigned long n);

  /// The lines of a parameter file that set something.
  std::string
  without_comments(const std::string &parameters);

  /// Where the effective parameters, versions and command come from: attributes of the HDF5 file.
  std::map<std::string, std::string>
  provenance(const std::string &effective, const std::string &command_line);

  /// Entries that differ between two parameter files (their texts), as "Body/Length was 1, is 2"; but for @p others.
  std::vector<std::string>
  differences(const std::string &before, const std::string &after, const std::vector<std::string> &others);

  /// The time since a study began, and what ends it before it is whole: a signal, which from now on ends it in order,
  /// or its time limit.
  class StudyClock
  {
  public:
    /// @p section: of the parameters, for words.
    explicit StudyClock(std::string section);

    void
    set_limit(std::optional<double> seconds);

    /// Is the time over, or has a signal arrived on this rank?
    bool
    is_over() const;

    /// Which of the two it was, if the study is not whole: "signal" or "time_limit"; empty if it @p is_whole
    /// (collective).
    std::string
    reason(MPI_Comm communicator, bool is_whole) const;

    /// "stopped by a signal", say, for a reason.
    std::string
    in_words(const std::string &reason) const;

    double
    seconds() const;

  private:
    const StopSignal signal_;
    const double begin_;
    const std::string section_;
    std::optional<double> limit_;
  };

  /// The parts of a study, which the ranks take one after the other.
  struct SharedWork
  {
    unsigned long n_parts;
    unsigned long n_points; ///< that are missing, in all parts together
    std::string points;     ///< what these are called: "points"
    /// Whether a signal or a time limit ends the work.
    std::function<bool()> interrupted;
    /// Computes part @p number and keeps what it gives. Calls @p see with the number of points that are kept and how
    /// many of these did not finish; asks @p stops at every step of a run. Returns false if it was interrupted. Throws
    /// FileError.
    std::function<bool(unsigned long number,
                       const std::function<bool()> &stops,
                       const std::function<void(unsigned long n, unsigned long failed)> &see)>
      compute;
    /// What rank 0 can say of the part that it computes, for whoever watches. Nothing: parts are short.
    std::function<std::string()> state = {};
    /// What rank 0 does for the others whenever it serves them (WorkQueue).
    std::function<void()> besides = {};
  };

  /// Returns false if some rank was interrupted (collective). A file that one rank cannot write ends the work of all:
  /// FileError on all ranks.
  bool
  share_work(MPI_Comm communicator, const SharedWork &work, Log &log);

  /// What went wrong with the files of any rank (empty: nothing) is a FileError on all of them (collective).
  void
  throw_on_all_ranks(MPI_Comm communicator, const std::string &problem);

  /// Collective.
  bool
  on_all_ranks(MPI_Comm communicator, bool here);
} // namespace crawler
