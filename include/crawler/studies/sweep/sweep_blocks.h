// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/sweep/sweep_numerics.h>

#include <functional>
#include <span>
#include <vector>

namespace crawler
{
  /// Returns 0, ..., @p n - 1, each once, spread out from the beginning. So the time left is known early, and a study
  /// that is stopped is a coarse picture of everything.
  std::vector<unsigned long>
  spread_out(unsigned long n);

  /// Largest number of points of a block.
  inline constexpr unsigned long largest_block = 256;

  /**
   * Points of a sweep in blocks of neighbours, which share the numerics if they can. Blocks do not depend on the number
   * of ranks or on rows that exist already, so neither do the answers. A block does not go beyond the end of the last
   * axis of a grid, or of the last two where the rows are short and the axis before it is of numbers: beyond, its
   * points would no longer be similar.
   */
  std::vector<SweepBlock>
  sweep_blocks(const SweepDesign &design);

  /// Blocks in the order in which they are computed: longest first, as far as that is known, by the duration and the
  /// number of digits wanted; otherwise spread over the whole sweep.
  std::vector<SweepBlock>
  sweep_blocks_in_order(SweepPoints &points);

  /**
   * Work of one rank in a sweep. The work is handed out in parts of blocks, small enough that each of @p n_ranks gets
   * several; the answers do not depend on the rank that computes a part, since the numerics are those of its block.
   */
  class SweepWork
  {
  public:
    /// @p note is told which points are computed. Points at which a process died come last and alone; those at which it
    /// died twice are not computed, and their rows say so.
    SweepWork(SweepPoints &points, unsigned int n_ranks, CrashNote *note = nullptr);

    unsigned long
    n_parts() const
    {
      return blocks_.size() * parts_of_block_;
    }

    /// Receives the rows of consecutive points, the first of which is number @p first.
    using WriteRows = std::function<void(unsigned long first, std::span<const RowFile::Row> rows)>;

    /// Computes the points of the part @p number that have no row yet (@p done), and passes their rows to @p write.
    /// Calls @p see when rows have been written, with their number and the number of these that did not finish. Returns
    /// false if it was interrupted. Throws what @p write throws.
    bool
    compute(unsigned long number,
            const std::vector<bool> &done,
            const WriteRows &write,
            const std::function<bool()> &interrupted,
            const std::function<void(unsigned long n, unsigned long failed)> &see);

  private:
    SweepBlock
    block_of(const unsigned long part) const
    {
      return blocks_[part / parts_of_block_];
    }
    /// Points of the part @p number, in order.
    std::vector<unsigned long>
    part(unsigned long number) const;

    /// Computes points of one part with the numerics that they share; returns those that succeeded.
    struct Point;
    std::vector<Point>
    compute_shared(const SweepBlock &block,
                   const std::vector<unsigned long> &points,
                   const std::function<bool()> &interrupted);

    /// Adds the requested sensitivities to the points that finished.
    void
    differentiate(std::vector<Point> &points, const std::function<bool()> &interrupted);

    /// Adds the other runs of a cross-check, if one is requested.
    void
    check(std::vector<Point> &points, const std::function<bool()> &interrupted) const;

    SweepPoints &points_;
    const std::vector<SweepBlock> blocks_; ///< sweep_blocks_in_order()
    const unsigned long parts_of_block_;
    const double time_limit_; ///< time limit of each point [s]
    SweepNumerics numerics_;
    CrashNote *const note_;
  };
} // namespace crawler
