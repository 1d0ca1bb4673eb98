// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/parameters.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// Something that varies over a sweep: an entry, or the parameter file itself.
  struct SweepAxis
  {
    static constexpr const char *file = "File";

    std::string entry; ///< "Section/Entry", or "File"
    /// Of a grid each value once, of a zip one for each point, of a random design those that it draws from, of a range
    /// its two ends: in any case what has to be admissible.
    std::vector<std::string> values;
    bool is_range = false, is_logarithmic = false;

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
    /// Reads the axes, with the CSV files that they name, whose names count from @p folder. Throws InputError in the
    /// name of the entry Sweep/Axes if they do not make sense, if the axes of a zip have different lengths or if there
    /// are more than SweepParameters::most_points.
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

    /// Of axis @p number. Of a grid the last one varies fastest. Nothing is kept for random points: they are computed.
    std::string
    value(std::size_t number, unsigned long point) const;

    /// From which the names of files on the axes count.
    const std::filesystem::path &
    folder() const
    {
      return folder_;
    }

    /// The points next to a point: of a grid one step away on one axis, otherwise the one before and the one after.
    std::vector<unsigned long>
    neighbours(unsigned long point) const;

    /// Does the entry vary from point to point?
    bool
    varies(const std::string &entry) const;

    /// Does point i have the value i of each axis?
    bool
    is_zip() const
    {
      return kind_ == Kind::zip;
    }

    /// So many points in succession differ in the last axis only: its length for a grid, otherwise 1.
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
