// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/run_gradient.h>

#include <vector>

namespace crawler
{
  /// 0, 1/n, ... 1, and both sides of some breaks.
  std::vector<double>
  equal_parts(std::size_t n, const std::vector<double> &breaks = {});

  /**
   * The smallest and the largest stretch in each of some equal boxes of body and duration. The extremes of a whole run
   * have kinks as functions of a gait where one crest becomes higher than another; those in small boxes hardly have,
   * so that an optimiser can go along a limit that holds many of them.
   */
  class ExtremesInBoxes
  {
  public:
    /// Breaks of the active stress, where the stretch may jump: parts of the length, or of the duration.
    struct Breaks
    {
      std::vector<double> in_space, in_time;
    };

    /// For runs of about so many strides.
    static std::size_t
    boxes_in_time(double strides);

    /// @p n_time boxes in time.
    ExtremesInBoxes(std::size_t n_time, double strides, const Breaks &breaks = {});

    /// Where and when a kymograph is wanted to tell them: parts of length and duration, and both sides of breaks.
    const std::vector<double> &
    points() const
    {
      return points_;
    }
    const std::vector<double> &
    times() const
    {
      return times_;
    }

    /// In all boxes, the smallest, then the largest, of a run that was seen there; sharpened between points and times
    /// that no break separates.
    std::vector<StretchPlace>
    find(const std::vector<double> &stretch) const;

    /// Of a run of which only the extremes are known: the others are as if there were no strain.
    std::vector<StretchPlace>
    place(const StretchPlace &smallest, const StretchPlace &largest) const;

  private:
    StretchPlace
    sharpened_at(const std::vector<double> &stretch, std::size_t i, std::size_t j, double sign) const;

    const std::size_t n_time_;
    std::vector<double> points_, times_;
  };
} // namespace crawler
