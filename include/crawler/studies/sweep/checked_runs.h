// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/compute.h>

#include <functional>
#include <vector>

namespace crawler
{
  /// Sweep/Cross-check: the other runs of a point, in both forms and refined, and the verdict of cross_check() on all.

  /// Columns of these runs in the table of a sweep (a contract, doc/user_guide.md, "Sweep").
  std::vector<RowFile::Column>
  checked_columns();

  /// Values in these columns for each of @p points, which have been computed, all with gait numbers or all without.
  /// Failures are the status of a run. The runs of all points share the lanes (compute_all()); each has the time limit
  /// of a point. Results are of no use once @p interrupted returns true.
  std::vector<RowFile::Row>
  checked_values(const std::vector<const Task *> &points, const std::function<bool()> &interrupted);
} // namespace crawler
