// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/core/command_options.h>

#include <mpi.h>

namespace crawler
{
  /// crawler run: one simulation with all its files (collective).
  ExitCode
  run(MPI_Comm communicator, const CommandOptions &options);
  /// Runs a parameter file that has been read already.
  ExitCode
  run_input(MPI_Comm communicator, const CommandOptions &options, ParameterFile file);
} // namespace crawler
