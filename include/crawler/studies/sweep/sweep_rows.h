// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/sweep/sweep_design.h>

#include <mpi.h>

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// The columns of results.h5 (a contract, doc/user_guide.md, "Sweep"): index, the axes, the numbers of summary.json
  /// with dots for nesting, those of the sensitivities that are wanted, seconds, reason, message, and status, which is
  /// written last.
  std::vector<RowFile::Column>
  sweep_columns(const SweepPoints &points);

  extern const std::string sweep_file, sweep_group; ///< results.h5, and the group in it

  /// The row of a point that has been computed, in the columns after the known ones.
  /// @p sensitivities: the entries by which it was differentiated.
  RowFile::Row
  sweep_row(const Task &task, const std::vector<SensitivityEntry> &sensitivities);

  /// What has become of a point, in a word, and why.
  struct PointStatus
  {
    std::string status, reason, message;
  };
  PointStatus
  status_of(const Task &task);

  /// How often which status and which reason stands in the table.
  struct SweepCounts
  {
    std::map<std::string, unsigned long> statuses, ///< "missing": not computed
      reasons;
    unsigned long n_points = 0;
  };

  /// Writes the table as comma-separated values beside it (results.csv of results.h5), in parts of some rows each,
  /// which the ranks share (collective); the counts are known on rank 0. Throws FileError, on all ranks.
  SweepCounts
  write_results_csv(MPI_Comm communicator,
                    const std::filesystem::path &folder,
                    const std::string &file  = sweep_file,
                    const std::string &group = sweep_group);

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
