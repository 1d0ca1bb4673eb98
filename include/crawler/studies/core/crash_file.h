// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <set>
#include <string>

namespace crawler
{
  /// File in the folder of a study in which a process that dies of a fault of its own (SIGSEGV, SIGBUS, SIGFPE, SIGILL,
  /// SIGABRT) notes the points it was computing: rows of a table, settings or starts.
  inline const std::string crash_file = "crashes.txt";

  /**
   * Writes that file: during the lifetime of the object, fault signals write a line of points before they end the
   * process as usual. One object at a time.
   */
  class CrashNote
  {
  public:
    /// Reads the notes of earlier processes. Throws FileError.
    explicit CrashNote(const std::filesystem::path &folder);
    ~CrashNote();
    CrashNote(const CrashNote &) = delete;
    CrashNote &
    operator=(const CrashNote &) = delete;

    /// Sets the points that are computed from now on: their names, which are words, separated by blanks; may be empty.
    void
    at_work_on(const std::string &points);

    /// Number of times a process died while it computed this point.
    unsigned int
    crashes_at(const std::string &point) const
    {
      return static_cast<unsigned int>(crashes_.count(point));
    }

    /// Returns true if processes died at this point so often that it is not tried again.
    bool
    is_given_up(const std::string &point) const
    {
      return crashes_at(point) >= 2;
    }

  private:
    std::multiset<std::string> crashes_; ///< points at which a process died, once for each time
  };

  /// Message of a point that is given up, whose reason is "crashed".
  inline const std::string crash_message =
    "the program crashed twice at this point; this is a bug in the program, please report it";
} // namespace crawler
