// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/log.h>
#include <crawler/studies/run/run.h>

#include <mpi.h>

namespace crawler
{
  /**
   * crawler sweep: a run without files for each point of section Sweep, shared among all ranks; the results are a
   * table, results.h5 and results.csv (collective). A point that fails is a row with status and reason. With --resume
   * the points that have no row yet are computed, with --strict rows that failed make the exit code 8.
   */
  ExitCode
  sweep(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file);

  /// Reports the size and the expected duration of the sweep in the parameter file (`crawler check`). Returns false if
  /// there is none.
  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log);
} // namespace crawler
