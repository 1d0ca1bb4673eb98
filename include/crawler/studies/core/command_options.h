// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <string>
#include <vector>

namespace crawler
{
  class Log;

  /// Command line without the name of the command.
  struct CommandOptions
  {
    std::string file;
    std::vector<std::string> overrides;
    std::string output;
    bool overwrite      = false;
    bool resume         = false;
    bool strict         = false;
    bool quiet          = false;
    bool check_gradient = false;
    std::string command_line;
    std::string petsc_options; ///< behind "--"
  };

  /// Logs the options behind "--".
  void
  announce_petsc_options(const CommandOptions &options, Log &log);

  /// Warns of PETSc options that no rank has read by the end: they are most likely misspelt (collective).
  void
  warn_of_unused_petsc_options(MPI_Comm communicator, const CommandOptions &options, Log &log);
} // namespace crawler
