// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/run.h>

namespace crawler
{
  class ParameterFile;

  /**
   * crawler sweep: a run without files for each point of section Sweep, shared among all ranks; the results are a
   * table, results.h5 and results.csv (collective). A point that goes wrong is a row with status and reason. With
   * --resume the points that have no row yet are computed, with --strict rows that failed make the exit code 8.
   */
  ExitCode
  sweep(MPI_Comm communicator, const CommandOptions &options);

  /// Does the parameter file declare a sweep? Then says how large it is and how long it will take (`crawler check`).
  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log);
} // namespace crawler
