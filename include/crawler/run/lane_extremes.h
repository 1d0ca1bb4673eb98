// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/lanes/lane_tables.h>

namespace crawler
{
  /**
   * The extreme stretches that the fused engine has seen in the stages of a step, of the position form: the same as
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

    /// Of stage @p i of @p step. If a sample may be a new extreme beyond @p least and @p most, the parabola through its
    /// neighbours in the cell comes closer.
    Range
    look(const LaneStep &step, unsigned int i, double least, double most) const;

  private:
    void
    sharpen(const LaneStep &step, unsigned int i, unsigned int sample, Extreme &now) const;

    const LaneTables &tables_;
  };
} // namespace crawler
