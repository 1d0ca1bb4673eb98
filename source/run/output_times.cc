// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/output_times.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  OutputTimes::OutputTimes(const std::vector<double> &asked, const std::vector<double> &needed, const double end_time)
    : end_time_(end_time)
  {
    for (const double time : asked)
      times_.push_back({time, false});
    for (const double part : needed)
    {
      const double time = part * end_time, same = 1e-12 * end_time;
      const auto place =
        std::lower_bound(times_.begin(), times_.end(), time - same, [](const Time &one, const double other) {
          return one.value < other;
        });
      if (place == times_.end() || place->value > time + same)
        times_.insert(place, {time, true});
    }
  }

  double
  OutputTimes::natural(const std::size_t i) const
  {
    const bool is_end = i + 1 == times_.size() && times_[i].value == end_time_;
    return is_end ? 1. : times_[i].value / end_time_;
  }

  std::vector<double>
  OutputTimes::of_segment(const TimeSegments &segments) const
  {
    const double reach = segments.is_last() ? HUGE_VAL : segments.end() - least_time_between_breaks;
    std::vector<double> result;
    for (std::size_t i = next_; i < times_.size() && natural(i) < reach; ++i)
      result.push_back(natural(i));
    if (!segments.is_last())
      result.push_back(segments.end());
    return result;
  }

  bool
  OutputTimes::include_end_of(const TimeSegments &segments) const
  {
    std::size_t i = next_;
    while (i < times_.size() && natural(i) < segments.end() - least_time_between_breaks)
      ++i;
    return i < times_.size() && natural(i) <= segments.end() + least_time_between_breaks;
  }

  double
  OutputTimes::next() const
  {
    return next_ < times_.size() ? natural(next_) : HUGE_VAL;
  }

  double
  OutputTimes::next_in_user_units() const
  {
    return next_ < times_.size() ? times_[next_].value : HUGE_VAL;
  }
} // namespace crawler
