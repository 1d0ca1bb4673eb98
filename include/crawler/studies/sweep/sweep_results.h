// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <filesystem>
#include <map>
#include <string>

namespace crawler
{
  /// How often which status and which reason stands in the table.
  struct SweepCounts
  {
    std::map<std::string, unsigned long> statuses, ///< "missing": not computed
      reasons;
    unsigned long n_points = 0;
  };

  /// Writes results.csv from results.h5, in parts of some rows each, which the ranks share (collective); the counts are
  /// known on rank 0. Throws FileError, on all ranks.
  SweepCounts
  write_results_csv(MPI_Comm communicator, const std::filesystem::path &folder);

  /// How a sweep ended.
  struct SweepEnd
  {
    std::string status, reason; ///< finished, or stopped by time_limit or signal
    double seconds;
    unsigned int n_ranks;
    unsigned long n_before; ///< rows that were there at the start
    std::string command_line;
  };

  /// Rows that this start has made.
  unsigned long
  n_computed(const SweepCounts &counts, const SweepEnd &end);

  /// The content of summary.json.
  std::string
  sweep_json(const SweepCounts &counts, const SweepEnd &end);
} // namespace crawler
