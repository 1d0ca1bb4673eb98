// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/scene.h>

#include <cstddef>
#include <vector>

namespace crawler
{
  /// Breaks in space of a scene, in units of its length.
  std::vector<double>
  breaks_in_space_of(const Scene &scene);

  /// Breaks in time of a scene, in units of its duration.
  std::vector<double>
  breaks_in_time_of(const Scene &scene);

  /**
   * Map from [0, 1] to [0, 1], linear between breaks, from the breaks of one scene to the nearby ones of another: where
   * several come together in the one, to their mean in the other.
   */
  class BreakMap
  {
  public:
    BreakMap(const std::vector<double> &from, const std::vector<double> &to);

    /// True if each break of the one scene has some of the other near it, and the other has no more except at the ends.
    bool
    is_good() const
    {
      return is_good_;
    }
    /// True if both have the same number of breaks.
    bool
    is_one_to_one() const;

    /// Number of the piece that contains @p x; the left one at a break.
    std::size_t
    piece(double x) const;
    double
    slope(std::size_t piece) const;
    double
    operator()(std::size_t piece, double x) const;
    double
    end(const std::size_t piece) const
    {
      return from_[piece + 1];
    }
    bool
    is_last(const std::size_t piece) const
    {
      return piece + 2 == from_.size();
    }

    /// Breaks of the other scene near break @p number of the one, where 0 is the start.
    const std::vector<double> &
    bunch(const std::size_t number) const
    {
      return bunches_[number];
    }
    double
    image_of_break(const std::size_t number) const
    {
      return to_[number];
    }
    /// Number of the piece of the other scene that this one becomes.
    std::size_t
    image(std::size_t piece) const;

  private:
    std::vector<double> from_, to_;
    std::vector<std::vector<double>> bunches_; ///< [break of the one, and both ends]
    bool is_good_ = true;
  };
} // namespace crawler
