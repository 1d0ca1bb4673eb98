// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <filesystem>
#include <string>

namespace crawler
{
  /**
   * Places of the program at which tests of kills, signals and interruptions stop it. A place is a state of the work,
   * not a time, so a test does the same on every machine. The environment variable
   *
   *     CRAWLER_STOP_AT=PLACE[:NUMBER]:SIGNAL[:RANK]
   *
   * raises SIGNAL (KILL, TERM, INT, USR1, SEGV, or STOP, which waits for CONT) in the process that reaches PLACE for
   * the NUMBER-th time (default 1), if it has this RANK of mpirun (default: any). PLACE is one of
   *
   * | place | reached |
   * |---|---|
   * | step | each check for a signal: at least once per time step of any computation |
   * | pilot | as step, in the runs of `crawler run` that choose the numerics |
   * | state | after each state written for --resume |
   * | row | after each row written to the table of a study |
   * | write:NAME | when a file is complete, before it gets this name |
   */
  enum class StopPlace
  {
    step,
    pilot,
    state,
    row
  };

  /// Notes that the work has reached this place @p times times. Throws InputError if CRAWLER_STOP_AT is none of the
  /// above.
  void
  reach(StopPlace place, unsigned long times = 1);

  /// Notes that a complete file is about to get this name. Throws as reach() does.
  void
  reach_write(const std::filesystem::path &path);

  /// Throws InputError if CRAWLER_STOP_AT is set but not as above.
  void
  check_stop_place();

  /// The request in CRAWLER_STOP_AT.
  struct StopWish
  {
    std::string place; ///< as in the table
    unsigned long number = 1;
    int signal           = 0;
    int rank             = -1; ///< -1: any
  };

  /// Reads a value of CRAWLER_STOP_AT. Throws InputError.
  StopWish
  stop_wish(const std::string &text);
} // namespace crawler
