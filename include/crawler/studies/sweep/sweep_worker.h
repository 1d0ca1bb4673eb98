// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/sweep/sweep_blocks.h>

#include <functional>
#include <vector>

namespace crawler
{
  /// One rank's part of the work of a sweep: computes the points of a block that have no row yet (@p done), and writes
  /// their rows. Calls @p see when rows have been written, with their number and how many of these did not finish.
  /// Returns false if it was interrupted. Throws FileError.
  bool
  compute_block(const SweepBlock &block,
                SweepPoints &points,
                const std::vector<bool> &done,
                RowFile &file,
                const std::function<bool()> &interrupted,
                const std::function<void(unsigned long n, unsigned long failed)> &see);
} // namespace crawler
