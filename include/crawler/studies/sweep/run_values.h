// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/compute.h>

#include <string>

namespace crawler
{
  // Values of a run in the table of a sweep.

  /// Number or word of a run under this key, and its value in a row; not a number or empty where it is unknown.
  const ResultEntry &
  entry_of(const std::string &key);
  RowFile::Value
  value_in_row(const Task &task, const ResultEntry &entry);

  /// Outcome of a point, in a word, and why.
  struct PointStatus
  {
    std::string status, reason, message;
  };
  PointStatus
  status_of(const Task &task);
} // namespace crawler
