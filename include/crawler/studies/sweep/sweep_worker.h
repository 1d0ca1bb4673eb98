// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/sweep/sweep_blocks.h>

#include <functional>
#include <vector>

namespace crawler
{
  /// One rank's part of the work of a sweep: computes blocks and writes their rows.
  class SweepWorker
  {
  public:
    /// @p done: which points have a row already.
    SweepWorker(SweepPoints &points,
                const std::vector<bool> &done,
                RowFile &file,
                const std::function<bool()> &interrupted);

    /// Calls @p see when rows have been written, with their number and how many of these did not finish. Returns false
    /// if it was interrupted. Throws FileError.
    bool
    compute(const SweepBlock &block, const std::function<void(unsigned long n, unsigned long failed)> &see);

  private:
    /// The rows of the tasks that are @p ready, those in succession at once.
    void
    write(const SweepBlock &block,
          const std::vector<Task> &tasks,
          const std::vector<bool> &ready,
          const std::function<void(unsigned long n, unsigned long failed)> &see);

    SweepPoints &points_;
    const std::vector<bool> &done_;
    RowFile &file_;
    const std::function<bool()> &interrupted_;
  };
} // namespace crawler
