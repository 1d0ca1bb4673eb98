// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>

#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace crawler
{
  /// Smallest and largest value of a field.
  using FieldRange = std::pair<double, double>;

  /**
   * The size that a field keeps to (to a tenth) but for 2 % of body and time. Colours and arrows of all pictures show
   * it in full and what is larger as if it were no larger, so that an instant of large values, as at a sudden start,
   * leaves the rest to be seen.
   */
  class UsualSize
  {
  public:
    /// The values at @p time, at equidistant places. Times ascend; a row counts for the time since the one before.
    void
    add(double time, std::span<const double> row);

    /// What no value exceeds, if the rows so far last no time.
    double
    value() const;

    /// The part of the range of all values in which none is larger.
    FieldRange
    within(const FieldRange &all) const;

    void
    exchange(Archive &archive)
    {
      archive(durations_, last_time_, largest_);
    }

  private:
    std::vector<std::pair<int, double>> durations_; ///< of sizes below 2^(first / 8), ascending
    double last_time_ = std::numeric_limits<double>::infinity(), largest_ = 0.;
  };
} // namespace crawler
