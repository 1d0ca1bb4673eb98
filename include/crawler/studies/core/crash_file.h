// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// A file of the folder of a study in which a process says, when it dies of a fault of its own (SIGSEGV, SIGBUS,
  /// SIGFPE, SIGILL, SIGABRT), on which of its points it was at work: rows of a table, settings or starts.
  extern const std::string crash_file;

  /**
   * Writes that file: from now on until this is gone, signals of faults write a line of points before they end the
   * process as they always do. One object at a time.
   */
  class CrashNote
  {
  public:
    explicit CrashNote(const std::filesystem::path &folder);
    ~CrashNote();
    CrashNote(const CrashNote &) = delete;
    CrashNote &
    operator=(const CrashNote &) = delete;

    /// These points, none if there are none, are computed from now on.
    void
    at_work_on(std::span<const unsigned long> points);
  };

  /// How often a process died at work on each point; points at which none did are not there. Throws FileError.
  using Crashes = std::map<unsigned long, unsigned int>;
  Crashes
  crashes_in(const std::filesystem::path &folder);

  /// Did processes die at work on this point, so that it is not tried again?
  bool
  is_given_up(unsigned long point, const Crashes &crashes);

  /// Points that are to be computed: where no process died, where one did, which are tried once more, each alone, and
  /// where two did, which are given up.
  struct PointsByCrashes
  {
    std::vector<unsigned long> usual, alone, given_up;
  };
  PointsByCrashes
  by_crashes(std::span<const unsigned long> points, const Crashes &crashes);

  /// The message of a point that is given up, whose reason is "crashed".
  extern const std::string crash_message;
} // namespace crawler
