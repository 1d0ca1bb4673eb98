// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/breaks.h>

#include <cstddef>
#include <vector>

namespace crawler
{
  /// Where the steps of a run must end: at the output times that were asked for, which it keeps to the last bit, and at
  /// times that only its record needs.
  class OutputTimes
  {
  public:
    /// @p asked: ascending, in (0, @p end_time] [time]. @p needed: ascending, in (0, 1), in units of the duration.
    OutputTimes(const std::vector<double> &asked, const std::vector<double> &needed, double end_time);

    /// From the next one to the end of the segment, which is the last of them if another segment follows; in units of
    /// the duration.
    std::vector<double>
    of_segment(const TimeSegments &segments) const;
    /// Is the end of the segment one of them?
    bool
    include_end_of(const TimeSegments &segments) const;

    /// The next one, if there is one; infinite otherwise. In units of the duration, and of the user.
    double
    next() const;
    double
    next_in_user_units() const;
    /// Was it asked for? So is the end, whether it is one of them or not.
    bool
    shows_next() const
    {
      return next_ == times_.size() || !times_[next_].is_hidden;
    }

    void
    pass()
    {
      if (next_ < times_.size())
        ++next_;
    }

  private:
    struct Time
    {
      double value; ///< [time]
      bool is_hidden;
    };

    double
    natural(std::size_t i) const;

    std::vector<Time> times_;
    double end_time_  = 1.;
    std::size_t next_ = 0;
  };
} // namespace crawler
