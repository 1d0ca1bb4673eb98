// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/core/command_options.h>

#include <mpi.h>

namespace crawler
{
  /**
   * crawler tradeoff: cost against true error of many settings on one scene, with a reference that is made and checked
   * here. The ranks share the settings, each measuring runs of its own (collective). A study that was stopped or killed
   * can be resumed.
   */
  ExitCode
  tradeoff(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file);
} // namespace crawler
