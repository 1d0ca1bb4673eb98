// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/study_folder.h>
#include <crawler/studies/sweep/sweep_inputs.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// The table of a study that has a row for each point of a design: where it is, and what stands in it.
  struct PointTable
  {
    std::string file;  ///< in the folder of the study, HDF5
    std::string group; ///< in the file
    std::vector<RowFile::Column> columns;
    std::size_t n_known; ///< index and axes: the first columns, which are known from the beginning
    std::string done;    ///< the column of texts that is written last: empty where nothing is computed yet
    /// Reasons with the seconds that were used up: rows that ran out of a time limit are computed again if it is
    /// larger.
    std::vector<std::pair<std::string, std::string>> reasons_and_seconds;
    double time_limit;  ///< [s]
    bool grows = false; ///< rows come as they are found: their number says nothing about the study

    /// Those that are written when a point is computed; the last one is `done`.
    std::vector<RowFile::Column>
    written_columns() const;
  };

  /// The reason of a point that took longer than the time limit.
  extern const std::string time_limit_reason;

  /// Index and axes.
  std::vector<RowFile::Column>
  axis_columns(const SweepDesign &design, const Declarations &declarations);

  /// Their values.
  RowFile::Known
  known_columns(const std::vector<RowFile::Column> &columns, const SweepDesign &design);

  /// What a study knows of its rows before it computes any.
  struct PlannedRows
  {
    unsigned long n;
    RowFile::Known known;                         ///< index and axes
    SweepInputs inputs;                           ///< what the rows depend on
    std::string effective;                        ///< all entries as they are used, as a .prm file
    std::map<std::string, std::string> more = {}; ///< attributes that are kept with them
  };

  /// Those of a sweep, whose table must outlive them.
  PlannedRows
  planned_rows(const PointTable &table, const SweepPoints &points);

  /// Makes the table without rows (one process).
  void
  create_table(const std::filesystem::path &folder,
               const PointTable &table,
               const PlannedRows &plan,
               const std::string &command_line);

  /// Makes the files of a new study, or, with --resume, looks for one that is the same. Returns which rows are there.
  /// Throws as StudyFolder::begin() and resume() (one process).
  std::vector<bool>
  begin_or_resume(StudyFolder &folder,
                  const PointTable &table,
                  const ParameterFile &file,
                  const PlannedRows &plan,
                  const std::string &command_line);
  /// What rank 0 finds with @p list, known to all ranks (collective).
  std::vector<bool>
  points_done(MPI_Comm communicator, const std::function<std::vector<bool>()> &list);
} // namespace crawler
