// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/lanes/lane_tables.h>

#include <vector>

namespace crawler
{
  /**
   * Extreme stretches that the fused engine has seen in the stages of a step, of the position form, as by
   * Assembler::stretch_range(). Natural units.
   */
  class LaneExtremes
  {
  public:
    struct Range
    {
      Extreme smallest, largest;
    };

    /// @p tables must outlive it.
    explicit LaneExtremes(const LaneTables &tables)
      : tables_(tables)
    {
    }

    /// Range of the stretch in stage @p i of @p step. If a sample may be a new extreme beyond @p least and @p most, the
    /// parabola through its neighbours in the cell comes closer. At @p breaks, in lengths of the body, the stretch may
    /// jump.
    Range
    look(const LaneStep &step, unsigned int i, double least, double most, const std::vector<double> &breaks) const;

  private:
    /// Stretch at a sample of a cell.
    double
    stretch_at(const LaneStep &step, unsigned int i, unsigned int cell, unsigned int place) const;
    /// Largest of the jumps at the ends of a cell that are no breaks.
    double
    jump_at(const LaneStep &step, unsigned int i, unsigned int cell, const std::vector<double> &breaks) const;
    void
    sharpen(const LaneStep &step, unsigned int i, unsigned int sample, Extreme &now) const;

    const LaneTables &tables_;
  };
} // namespace crawler
