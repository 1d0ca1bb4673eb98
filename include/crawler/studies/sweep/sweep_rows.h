// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/sweep/sweep_design.h>

#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// The columns of results.h5 (a contract, doc/user_guide.md, "Sweep"): index, the axes, the numbers of summary.json
  /// with dots for nesting, seconds, reason, message, and status, which is written last.
  std::vector<RowFile::Column>
  sweep_columns(const SweepDesign &design, const Declarations &declarations);

  extern const std::string sweep_file, sweep_group; ///< results.h5, and the group in it

  /// The row of a point that has been computed, in the columns after the known ones.
  RowFile::Row
  sweep_row(const Task &task);

  /// What has become of a point, in a word, and why.
  struct PointStatus
  {
    std::string status, reason, message;
  };
  PointStatus
  status_of(const Task &task);
} // namespace crawler
