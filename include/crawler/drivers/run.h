// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <mpi.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// What the command line says besides the name of the command.
  struct CommandOptions
  {
    std::string file;
    std::vector<std::string> overrides;
    std::string output;
    bool overwrite = false;
    bool resume    = false;
    bool strict    = false;
    bool quiet     = false;
    std::string command_line;
  };

  class Log;
  struct Input;
  struct TimeOutcome;

  /// Logs body and active stress.
  void
  report_scene(Log &log, const Input &input);

  /// Makes the output folder with the files that a run begins with: parameters, log, and active_stress.csv if the input
  /// asks for it. Throws FileError.
  void
  begin_files(Log &log, const Input &input, const std::filesystem::path &folder);

  /// What a run that ended like this returns to the shell.
  ExitCode
  exit_code(const TimeOutcome &outcome);

  /// crawler run: one simulation with all its files (collective).
  ExitCode
  run(MPI_Comm communicator, const CommandOptions &options);

  /// crawler check: says what run would do; nothing is run but the pilots that choose the mesh, nothing is written.
  ExitCode
  check(MPI_Comm communicator, const CommandOptions &options);
} // namespace crawler
