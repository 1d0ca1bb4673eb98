// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/run_gradient.h>

#include <vector>

namespace crawler
{
  /**
   * Smallest and largest stretch in each of some equal boxes of body and duration. The extremes of a whole run have
   * kinks as functions of a gait where one crest becomes higher than another; those in small boxes hardly do, so that
   * an optimiser can move along a limit at which many of them lie.
   */
  class ExtremesInBoxes
  {
  public:
    /// Breaks of the active stress, where the stretch may jump: parts of the length, or of the duration.
    struct Breaks
    {
      std::vector<double> in_space, in_time;
    };

    /// Number of boxes in time for runs of about this number of strides.
    static std::size_t
    boxes_in_time(double strides);

    /// @p n_time boxes in time.
    ExtremesInBoxes(std::size_t n_time, double strides, const Breaks &breaks = {});

    /// Points and times at which a kymograph is needed to find them: parts of length and duration, and both sides of
    /// breaks.
    const std::vector<double> points, times;

    /// Extremes in all boxes, first the smallest, then the largest, of a run with this @p stretch at points and times;
    /// refined between points and times that no break separates.
    std::vector<StretchPlace>
    find(const std::vector<double> &stretch) const;

    /// Extremes of a run of which only these two are known: the others are set to zero strain.
    std::vector<StretchPlace>
    place(const StretchPlace &smallest, const StretchPlace &largest) const;

  private:
    StretchPlace
    sharpened_at(const std::vector<double> &stretch, std::size_t i, std::size_t j, double sign) const;

    const std::size_t n_time_;
  };
} // namespace crawler
