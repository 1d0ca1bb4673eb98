// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/compute.h>

#include <functional>
#include <vector>

namespace crawler
{
  /// Sweep/Cross-check: the other runs of a point, in both forms and refined, and what cross_check() says of them all.

  /// Their columns in the table of a sweep (a contract, doc/user_guide.md, "Sweep").
  std::vector<RowFile::Column>
  checked_columns();

  /// What stands in these columns for each of @p points, which have been computed with gait numbers or without, all
  /// alike. What goes wrong is the status of a run. The runs of all points share the lanes (compute_all()); the time
  /// limit of a point is that of each. Of no use once @p interrupted says so.
  std::vector<RowFile::Row>
  checked_values(const std::vector<const Task *> &points, const std::function<bool()> &interrupted);
} // namespace crawler
