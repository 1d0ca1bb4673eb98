// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// The whole program behind main(): starts MPI and PETSc, reads the command line, runs the command, says what went
  /// wrong in one sentence, and returns the exit code.
  int
  run_command_line(int argc, char **argv);
} // namespace crawler
