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
   * The size that a field exceeds only on 2 % of body and time (to a tenth). Colours and arrows of all pictures are cut
   * off there, so that an instant of large values, as at a sudden start, does not hide the rest.
   */
  class UsualSize
  {
  public:
    /// Adds the values at @p time, at equidistant places. Times ascend; a row counts for the time since the previous
    /// one.
    void
    add(double time, std::span<const double> row);

    /// The usual size; the largest size if the rows so far last no time.
    double
    value() const;

    /// Part of the range @p all that is within the usual size.
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
