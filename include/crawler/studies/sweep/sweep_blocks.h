// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <functional>
#include <vector>

namespace crawler
{
  /// Points in succession that are computed together, and share the numerics if they can.
  struct SweepBlock
  {
    unsigned long first, size;
  };

  /**
   * All points of a sweep in blocks, of at most 64 points and at least 256 blocks if there are as many points. They do
   * not depend on the number of ranks or on what is done already, so neither do the answers. A block does not go beyond
   * the end of the last axis of a grid, where its points would not be similar any more. Nothing is kept for a block.
   */
  class SweepBlocks
  {
  public:
    explicit SweepBlocks(const SweepDesign &design);

    unsigned long
    size() const;

    SweepBlock
    operator[](unsigned long number) const;

  private:
    unsigned long n_runs_, run_length_, parts_of_run_;
  };

  /**
   * The order in which the blocks are computed. Longest first, as far as that is known: by the duration and the number
   * of digits wanted. Otherwise spread over the whole sweep from the beginning (golden_stride() in study.h), so the
   * time left is known early.
   */
  class SweepOrder
  {
  public:
    SweepOrder(const SweepBlocks &blocks, SweepPoints &points);

    /// The number of the block whose turn it is as number @p i.
    unsigned long
    operator[](unsigned long i) const;

  private:
    const unsigned long size_, stride_;
    std::vector<unsigned long> sorted_; ///< empty if all take equally long, as far as is known
  };

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
