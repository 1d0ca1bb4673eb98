// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/output_times.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    bool
    is_same(const double a, const double b)
    {
      return std::abs(a - b) <= min_time_between_breaks;
    }
  } // namespace

  OutputTimes::OutputTimes(PictureTimes pictures, std::vector<double> needed, const bool is_dense)
    : pictures_(std::move(pictures))
    , step_ends_(std::move(needed))
  {
    if (is_dense)
      return;
    // Times of snapshots are kept to the last bit.
    std::vector<double> snapshots;
    for (std::size_t i = 0; i < pictures_.all().size(); ++i)
      if (pictures_.all()[i].kinds.is_snapshot)
        snapshots.push_back(pictures_.natural(i));
    std::erase_if(step_ends_, [&](const double time) {
      return std::ranges::any_of(snapshots, [time](const double snapshot) { return is_same(snapshot, time); });
    });
    step_ends_.insert(step_ends_.end(), snapshots.begin(), snapshots.end());
    std::ranges::sort(step_ends_);
  }

  std::vector<double>
  OutputTimes::of_segment(const TimeSegments &segments, const double time) const
  {
    const double reach = segments.is_last() ? HUGE_VAL : segments.end() - min_time_between_breaks;
    std::vector<double> result;
    for (const double end : step_ends_)
      if (end > time + min_time_between_breaks && end < reach)
        result.push_back(end);
    if (!segments.is_last())
      result.push_back(segments.end());
    return result;
  }

  double
  OutputTimes::next() const
  {
    return next_ < pictures_.all().size() ? pictures_.natural(next_) : HUGE_VAL;
  }

  const PictureTimes::Time *
  OutputTimes::passed_at(const double time) const
  {
    const bool has_passed = next_ > 0 && next_ <= pictures_.all().size();
    return has_passed && is_same(pictures_.natural(next_ - 1), time) ? &pictures_.all()[next_ - 1] : nullptr;
  }
} // namespace crawler
