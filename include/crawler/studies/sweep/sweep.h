// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/log.h>
#include <crawler/studies/run/run.h>

#include <mpi.h>

#include <string>

namespace crawler
{
  /**
   * crawler sweep: a run without files for each point of section Sweep, shared among all ranks; the results are a
   * table, results.h5 and results.csv (collective). A point that goes wrong is a row with status and reason. With
   * --resume the points that have no row yet are computed, with --strict rows that failed make the exit code 8.
   *
   * The parts, each used by those below it: sweep_design.h, which values the axes take; sweep_points.h, the parameters
   * of a point; sweep_blocks.h, what is computed together and in which order; sweep_rows.h, columns, rows and results
   * of the table; sweep_inputs.h, what the answers depend on; point_table.h, to begin or to resume; sweep_worker.h, one
   * rank's work.
   */
  ExitCode
  sweep(MPI_Comm communicator, const CommandOptions &options);
  /// The same of a parameter file that is read already.
  ExitCode
  sweep_input(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file);

  class SweepDesign;

  /// Does the parameter file declare a sweep? Then says how large it is and how long it will take (`crawler check`).
  bool
  check_sweep(MPI_Comm communicator, const ParameterFile &file, Log &log);

  /// "6 points, grid over Body/Length (2 values), ..."
  std::string
  in_words(const SweepDesign &design, const std::string &design_name);
} // namespace crawler
