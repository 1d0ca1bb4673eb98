// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/run_gradient.h>

#include <vector>

namespace crawler
{
  /// 0, 1/n, ... 1.
  std::vector<double>
  equal_parts(std::size_t n);

  /**
   * The smallest and the largest stretch in each of some equal boxes of body and duration. The extremes of a whole run
   * have kinks as functions of a gait where one crest becomes higher than another; those in small boxes hardly have,
   * so that an optimiser can go along a limit that holds many of them.
   */
  class ExtremesInBoxes
  {
  public:
    /// @p strides: of the run.
    explicit ExtremesInBoxes(double strides);

    /// In all boxes: the smallest, then the largest.
    std::size_t
    size() const
    {
      return 2 * n_space_ * n_time_;
    }

    /// Where and when a kymograph is wanted to tell them: parts of length and duration.
    std::vector<double>
    points() const;
    std::vector<double>
    times() const;

    /// Of a run that was seen there, sharpened between the points and times.
    std::vector<StretchPlace>
    find(const std::vector<double> &stretch) const;

    /// Of a run of which only the extremes are known: the others are as if there were no strain.
    std::vector<StretchPlace>
    place(const StretchPlace &smallest, const StretchPlace &largest) const;

  private:
    static constexpr std::size_t n_space_ = 8, per_box_ = 16;

    const std::size_t n_time_, times_per_box_;
  };
} // namespace crawler
