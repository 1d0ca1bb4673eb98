// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/output/picture_times.h>
#include <crawler/scene/breaks.h>

namespace crawler
{
  /// Required ends of steps of a run, and the pictures that it passes. Times are in units of the duration.
  class OutputTimes
  {
  public:
    /// @p needed is ascending, in (0, 1). @p is_dense: the integrator knows the state at any time within a step as well
    /// as at its ends, so steps need not end at snapshots.
    OutputTimes(PictureTimes pictures, std::vector<double> needed, bool is_dense);

    /// Ends of steps after @p time until the end of the segment, which is the last of them if another one follows.
    std::vector<double>
    of_segment(const TimeSegments &segments, double time) const;

    /// Time of the next picture; infinite if there is none.
    double
    next() const;
    /// Next picture, which must exist.
    const PictureTimes::Time &
    picture() const
    {
      return pictures_.all()[next_];
    }
    void
    pass()
    {
      ++next_;
    }
    /// Last picture that was passed, if it is of this time.
    const PictureTimes::Time *
    passed_at(double time) const;

    void
    exchange(Archive &archive)
    {
      archive(next_);
    }

  private:
    PictureTimes pictures_;
    std::vector<double> step_ends_;
    std::size_t next_ = 0;
  };
} // namespace crawler
