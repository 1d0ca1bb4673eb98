// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/log.h>

#include <mpi.h>

namespace crawler
{
  /// Logs the options behind "--".
  void
  announce_petsc_options(const CommandOptions &options, Log &log);

  /// Warns of PETSc options that no rank has read by the end: they are most likely misspelt (collective).
  void
  warn_of_unused_petsc_options(MPI_Comm communicator, const CommandOptions &options, Log &log);
} // namespace crawler
