// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /// Number of this process as its launcher (mpirun, srun) says in the environment, before MPI is started; 0 without
  /// one.
  unsigned int
  rank_of_launcher();

  /// How another program ended.
  struct ProgramEnd
  {
    bool started = false;
    int status   = -1;  ///< that of its end; -1: a signal ended it, or it did not start
    std::string errors; ///< what it wrote to its standard error
  };

  /// Runs another program, which is looked for in the PATH, without input, and waits for its end. What it writes to its
  /// standard output is shown if @p shown. Signals that stop this process (SIGINT, SIGTERM, SIGUSR1) stop that program
  /// instead.
  ProgramEnd
  run_program(const std::vector<std::string> &command, bool shown);

  /// Does @p work in a copy of this process, and waits for its end. Returns whether it came to one, with or without an
  /// exception: false if it crashed or took more than so many @p seconds of processor time. Nothing else is left of it:
  /// for libraries that damaged files can crash. MPI must not be called in it.
  bool
  comes_to_an_end(const std::function<void()> &work, unsigned int seconds);
} // namespace crawler
