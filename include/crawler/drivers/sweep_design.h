// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/sweep_parameters.h>

#include <string>
#include <vector>

namespace crawler
{
  /// What Sweep/Axes reads, in words.
  extern const std::string sweep_syntax;

  /// Something that varies over a sweep: an entry, or the parameter file itself.
  struct SweepAxis
  {
    static constexpr const char *file = "File";

    std::string entry;                   ///< "Section/Entry", or "File"
    std::vector<std::string> values;     ///< of a grid: the different ones; otherwise one for each point
    std::vector<std::string> admissible; ///< what has to be looked at before: all values that may occur

    bool
    is_file() const
    {
      return entry == file;
    }
  };

  /// All points of a sweep, numbered from 0.
  class SweepDesign
  {
  public:
    /// Reads the axes, with the CSV files that they name. Throws InputError in the name of the entry Sweep/Axes if they
    /// do not make sense, if the axes of a zip have different lengths or if there are more than 1e8 points.
    explicit SweepDesign(const SweepParameters &parameters);

    unsigned long
    n_points() const
    {
      return n_points_;
    }
    const std::vector<SweepAxis> &
    axes() const
    {
      return axes_;
    }

    /// Of a grid the last axis varies fastest.
    const std::string &
    value(std::size_t axis, unsigned long point) const;

    /// So many points in succession differ in the last axis only: its length for a grid, otherwise 1.
    unsigned long
    run_length() const
    {
      return is_grid_ ? axes_.back().values.size() : 1;
    }

  private:
    void
    draw(const SweepParameters &parameters, const std::vector<std::string> &texts);

    std::vector<SweepAxis> axes_;
    bool is_grid_;
    unsigned long n_points_ = 0;
  };
} // namespace crawler
