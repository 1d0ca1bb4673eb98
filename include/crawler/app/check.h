// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/studies/core/command_options.h>

#include <mpi.h>

namespace crawler
{
  /// crawler check: says what run would do; nothing is run but the pilots that choose the mesh, nothing is written.
  ExitCode
  check(MPI_Comm communicator, const CommandOptions &options);
} // namespace crawler
