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
  run(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file);
} // namespace crawler
