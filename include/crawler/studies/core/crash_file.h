// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// File in the folder of a study in which a process that dies of a fault of its own (SIGSEGV, SIGBUS, SIGFPE, SIGILL,
  /// SIGABRT) notes the points it was computing: rows of a table, settings or starts.
  extern const std::string crash_file;

  /**
   * Writes that file: during the lifetime of the object, fault signals write a line of points before they end the
   * process as usual. One object at a time.
   */
  class CrashNote
  {
  public:
    explicit CrashNote(const std::filesystem::path &folder);
    ~CrashNote();
    CrashNote(const CrashNote &) = delete;
    CrashNote &
    operator=(const CrashNote &) = delete;

    /// Sets the points that are computed from now on; may be empty.
    void
    at_work_on(std::span<const unsigned long> points);
  };

  /// Number of times a process died while computing each point; other points are absent. Throws FileError.
  using Crashes = std::map<unsigned long, unsigned int>;
  Crashes
  crashes_in(const std::filesystem::path &folder);

  /// Returns true if processes died at this point so often that it is not tried again.
  bool
  is_given_up(unsigned long point, const Crashes &crashes);

  /// Points to compute: those where no process died; those where one did, which are tried once more, each alone; and
  /// those where two did, which are given up.
  struct PointsByCrashes
  {
    std::vector<unsigned long> usual, alone, given_up;
  };
  PointsByCrashes
  by_crashes(std::span<const unsigned long> points, const Crashes &crashes);

  /// Message of a point that is given up, whose reason is "crashed".
  extern const std::string crash_message;
} // namespace crawler
