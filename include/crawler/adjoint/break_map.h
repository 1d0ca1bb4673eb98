// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/scene.h>

#include <cstddef>
#include <vector>

namespace crawler
{
  /// Of a scene, in units of its length.
  std::vector<double>
  breaks_in_space_of(const Scene &scene);

  /// In units of its duration.
  std::vector<double>
  breaks_in_time_of(const Scene &scene);

  /**
   * [0, 1] to [0, 1], linear between breaks and taking those of one scene to those of another, which are near them:
   * where several come together in the one, to the mean of what they are in the other.
   */
  class BreakMap
  {
  public:
    BreakMap(const std::vector<double> &from, const std::vector<double> &to);

    /// Has each break of the one some of the other near it, and the other no more but at the ends?
    bool
    is_good() const
    {
      return is_good_;
    }
    /// Are they as many?
    bool
    is_one_to_one() const;

    /// The number of the piece in which @p x is; the left one at a break.
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

    /// The breaks of the other scene near break @p number of the one, where 0 is the start, and what they are taken
    /// for.
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
    /// The number of the piece of the other scene that this one becomes.
    std::size_t
    image(std::size_t piece) const;

  private:
    std::vector<double> from_, to_;
    std::vector<std::vector<double>> bunches_; ///< [break of the one, and both ends]
    bool is_good_ = true;
  };
} // namespace crawler
