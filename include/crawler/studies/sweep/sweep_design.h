// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/parameters.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// Quantity that varies over a sweep: an entry, or the parameter file itself.
  struct SweepAxis
  {
    static constexpr const char *file = "File";

    std::string entry; ///< "Section/Entry", or "File"
    /// Values of the axis: of a grid each one once, of a zip one for each point, of a random design those that it draws
    /// from, of a range its two ends; all of them must be admissible.
    std::vector<std::string> values;
    bool is_range = false, is_logarithmic = false;

    bool
    is_file() const
    {
      return entry == file;
    }
  };

  /// Points of a sweep, numbered from 0; a single one if there are no axes.
  class SweepDesign
  {
  public:
    /// Reads the axes, with the CSV files that they name, relative to @p folder. Throws InputError in the name of the
    /// entry Sweep/Axes if they do not make sense, if the axes of a zip have different lengths or if there are more
    /// than SweepParameters::max_points.
    explicit SweepDesign(const SweepParameters &parameters, std::filesystem::path folder = "");

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

    /// Value of axis @p number at a point. The last axis of a grid varies fastest. Random values are not stored but
    /// computed.
    std::string
    value(std::size_t number, unsigned long point) const;

    /// Folder to which the names of files on the axes are relative.
    const std::filesystem::path &
    folder() const
    {
      return folder_;
    }

    /// Points next to a point: of a grid one step away on one axis, otherwise the previous one and the next one.
    std::vector<unsigned long>
    neighbours(unsigned long point) const;

    /// Returns true if the entry varies from point to point.
    bool
    varies(const std::string &entry) const
    {
      return std::any_of(axes_.begin(), axes_.end(), [&](const SweepAxis &axis) { return axis.entry == entry; });
    }

    /// Returns true if point i has the value i of each axis.
    bool
    is_zip() const
    {
      return kind_ == Kind::zip;
    }

    /// Number of consecutive points that differ in the last axis only: its length for a grid, otherwise 1.
    unsigned long
    run_length() const
    {
      return kind_ == Kind::grid ? axes_.back().values.size() : 1;
    }

  private:
    enum class Kind
    {
      grid,
      zip,
      random,
      latin_hypercube
    };

    SweepAxis
    read_axis(const std::string &entry, const std::string &text, const std::string &design) const;

    std::filesystem::path folder_;
    std::vector<SweepAxis> axes_;
    Kind kind_;
    unsigned int seed_;
    unsigned long n_points_ = 0;
  };
} // namespace crawler
