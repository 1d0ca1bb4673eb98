// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/row_file.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/sweep/sweep_numerics.h>

#include <functional>
#include <map>
#include <span>
#include <vector>

namespace crawler
{
  /**
   * All points of a sweep in blocks of at most 256 neighbours, which share the numerics if they can. They do not depend
   * on the number of ranks or on what is done already, so neither do the answers. A block does not go beyond the end of
   * the last axis of a grid, or of the last two where the rows are short and the axis before it is of numbers: there
   * its points would not be similar any more. Nothing is kept for a block.
   */
  class SweepBlocks
  {
  public:
    static constexpr unsigned long most = 256;

    explicit SweepBlocks(const SweepDesign &design);

    unsigned long
    size() const;

    /// Points of the largest block.
    unsigned long
    largest() const;

    SweepBlock
    operator[](unsigned long number) const;

  private:
    unsigned long row_ = 1, rows_, n_runs_, parts_of_run_; ///< points in a row, rows in a run, which is cut into parts
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

  /**
   * One rank's part of the work of a sweep. The work is handed out in parts of blocks, small enough that each of
   * @p n_ranks gets several; who computes a part does not change its answers, since the numerics are those of its
   * block.
   */
  class SweepWork
  {
  public:
    SweepWork(SweepPoints &points, unsigned int n_ranks);

    unsigned long
    n_parts() const;

    /// Takes the rows of points in succession, from the one with this number on.
    using WriteRows = std::function<void(unsigned long first, std::span<const RowFile::Row> rows)>;

    /// Points at which a process died before come last and alone from now on; those at which it died twice are not
    /// computed, and their rows say so. @p note is told which are computed, and must live as long as this.
    void
    beware_of(Crashes crashes, CrashNote &note);

    /// Computes the points of the part @p number that have no row yet (@p done), and gives their rows to @p write.
    /// Calls
    /// @p see when rows have been written, with their number and how many of these did not finish. Returns false if it
    /// was interrupted. Throws what @p write throws.
    bool
    compute(unsigned long number,
            const std::vector<bool> &done,
            const WriteRows &write,
            const std::function<bool()> &interrupted,
            const std::function<void(unsigned long n, unsigned long failed)> &see);

    /// The answers of the points of the part @p number, without files; their number.
    unsigned long
    try_out(unsigned long number);

  private:
    SweepBlock
    block_of(unsigned long part) const;
    /// Its points, in order.
    std::vector<unsigned long>
    part(unsigned long number) const;

    /// Computes points of one part with the numerics that they share; what it returns has been computed.
    struct Point;
    std::vector<Point>
    compute_shared(const SweepBlock &block,
                   const std::vector<unsigned long> &points,
                   const std::function<bool()> &interrupted);

    /// Adds the sensitivities that are wanted to those that finished.
    void
    differentiate(std::vector<Point> &points, const std::function<bool()> &interrupted);

    /// Adds the other runs of a cross-check, if one is wanted.
    void
    check(std::vector<Point> &points, const std::function<bool()> &interrupted) const;

    SweepPoints &points_;
    const SweepBlocks blocks_;
    const SweepOrder order_;
    const unsigned long parts_of_block_;
    const double time_limit_; ///< for each point [s]
    SweepNumerics numerics_;
    Crashes crashes_; ///< how often a process died at a point
    CrashNote *note_ = nullptr;
  };
} // namespace crawler
