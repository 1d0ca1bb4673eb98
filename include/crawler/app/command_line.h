// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Runs the whole program behind main(): reads the command line, starts MPI and PETSc if the command needs them, runs
  /// it, reports errors in one sentence, and returns the exit code.
  int
  run_command_line(int argc, char **argv);
} // namespace crawler
