// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/sweep/sweep_inputs.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <mpi.h>

#include <cmath>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// Table of a study that has a row for each point of a design: its place, and its content as far as it is known
  /// before any point is computed.
  struct PointTable
  {
    std::string file;  ///< in the folder of the study, HDF5
    std::string group; ///< in the file
    std::vector<RowFile::Column> columns;
    std::string effective; ///< all entries as used, as a .prm file
    unsigned long n_rows;
    RowFile::Known known = {}; ///< index and axes: the first columns, known from the beginning
    SweepInputs inputs   = {}; ///< inputs on which the rows depend (one process reads them)
    /// Reasons with the seconds used: rows that ran out of a time limit are computed again if it is increased.
    std::vector<std::pair<std::string, std::string>> reasons_and_seconds = {};
    double time_limit                                                    = HUGE_VAL; ///< [s]
    bool grows = false; ///< rows come as they are found: their number is not that of the study
    std::map<std::string, std::string> others = {}; ///< attributes that are kept with the rows

    /// Columns that are written when a point is computed; the last one is the status, which is empty before.
    std::vector<RowFile::Column>
    written_columns() const;

    /// Attributes of the table in its file.
    std::map<std::string, std::string>
    attributes(const std::string &command_line) const;
  };

  /// Value in a row of a number or word of a run; not a number or empty where it is unknown.
  RowFile::Value
  value_in_row(const Task &task, const ResultEntry &entry);

  /// Columns of index and axes.
  std::vector<RowFile::Column>
  axis_columns(const SweepDesign &design, const Declarations &declarations);

  /// Values of these columns.
  RowFile::Known
  known_columns(const std::vector<RowFile::Column> &columns, const SweepDesign &design);

  /// Makes the table without rows (one process).
  void
  create_table(const StudyFolder &folder, const PointTable &table);

  /// Makes the files of a new study, or, with --resume, looks for the same study. Returns which rows exist. Throws as
  /// StudyFolder::begin() and resume() (one process).
  std::vector<bool>
  begin_or_resume(StudyFolder &folder, const PointTable &table, const ParameterFile &file);

  /// Sends the result of @p list on rank 0 to all ranks (collective).
  std::vector<bool>
  points_done(MPI_Comm communicator, const std::function<std::vector<bool>()> &list);

  /// Writes the table of a RowFile as comma-separated values beside it, in parts of some rows each, which the ranks
  /// share (collective). Throws FileError, on all ranks.
  void
  write_table_csv(MPI_Comm communicator, const std::filesystem::path &table, const std::string &group);
} // namespace crawler
