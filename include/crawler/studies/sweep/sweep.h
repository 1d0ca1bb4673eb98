// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/run/run.h>

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
} // namespace crawler
