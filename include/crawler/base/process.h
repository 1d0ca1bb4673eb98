// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /// Rank of this process as its launcher (mpirun, srun) gives it in the environment, before MPI is started; 0 without
  /// a launcher.
  unsigned int
  rank_of_launcher();

  /// Outcome of another program.
  struct ProgramEnd
  {
    bool started = false;
    int status   = -1;    ///< exit status; -1: a signal ended it, or it did not start
    bool stopped = false; ///< SIGINT, SIGTERM or SIGUSR1 ended it
    std::string errors;   ///< its standard error
  };

  /// Runs another program, searched for in the PATH, without input, and waits for its end. Its standard output is shown
  /// if @p shown. Signals that would stop this process (SIGINT, SIGTERM, SIGUSR1) stop that program instead; it begins
  /// with these signals blocked, and unblocks them when it can stop in order.
  ProgramEnd
  run_program(const std::vector<std::string> &command, bool shown);

  /// Does @p work in a copy of this process and waits for its end. Returns true if it ended, with or without an
  /// exception, false if it crashed or took more than @p seconds of processor time. It has no other effect: meant for
  /// libraries that damaged files can crash. MPI must not be called in it.
  bool
  comes_to_an_end(const std::function<void()> &work, unsigned int seconds);
} // namespace crawler
