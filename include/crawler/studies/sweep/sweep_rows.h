// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/sweep/cross_check.h>
#include <crawler/studies/sweep/point_table.h>

#include <mpi.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// Columns of results.h5 (a contract, doc/user_guide.md, "Sweep"): index, the axes, the numbers of summary.json with
  /// dots for nesting, those of the requested sensitivities, those of a cross-check (cross_check.h), seconds, reason,
  /// message, and status, which is written last.
  std::vector<RowFile::Column>
  sweep_columns(const SweepPoints &points);

  inline const std::string sweep_file = "results.h5", sweep_group = "results"; ///< table, and the group in it

  /// Row of a point that has been computed, in the columns after the known ones. @p sensitivities: the entries by which
  /// it was differentiated; @p checked: values of checked_columns(), if there are any.
  RowFile::Row
  sweep_row(const Task &task, const std::vector<SensitivityEntry> &sensitivities, const RowFile::Row &checked = {});

  /// Number of rows with each status, reason and verdict in the table.
  struct SweepCounts
  {
    std::map<std::string, unsigned long> statuses, ///< "missing": not computed
      reasons, verdicts;
    unsigned long n_points = 0;
    std::map<unsigned long, std::string> wrong_answers; ///< the first few by point, each in a sentence
    double largest_error_ratio = NAN;

    unsigned long
    number_of(Verdict::Kind kind) const;
    /// Number of points with at least two answers.
    unsigned long
    checked() const
    {
      return number_of(Verdict::agree) + number_of(Verdict::silent_wrong_answer);
    }
  };

  /// Writes the table as comma-separated values beside it (results.csv of results.h5), and counts its rows on rank 0
  /// (collective). Throws FileError, on all ranks.
  SweepCounts
  write_results_csv(MPI_Comm communicator,
                    const std::filesystem::path &folder,
                    const std::string &file  = sweep_file,
                    const std::string &group = sweep_group);

  /// End of a sweep.
  struct SweepEnd
  {
    std::string status, reason; ///< finished, or stopped by time_limit or signal
    double seconds;
    unsigned int n_ranks;
    unsigned long n_before; ///< rows that existed at the start
    std::string command_line;
  };

  /// Number of rows that this start has computed.
  unsigned long
  n_computed(const SweepCounts &counts, const SweepEnd &end);

  /// Content of summary.json.
  std::string
  sweep_json(const SweepCounts &counts, const SweepEnd &end);
} // namespace crawler
