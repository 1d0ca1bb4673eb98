// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/grid_samples.h>
#include <crawler/output/output_parameters.h>
#include <crawler/output/picture_times.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/scene.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr unsigned int per_stride = 64, max_snapshots = 640, min_rows = 128, max_strides = 20;
    constexpr std::size_t max_jumps     = 1000;
    constexpr double strides_if_unknown = 4.;
    /// Times closer than this are one, in units of the duration.
    constexpr double same_time = 1e-12;
  } // namespace

  PictureTimes::PictureTimes(const std::vector<double> &snapshots,
                             const std::vector<double> &rows,
                             const double end_time)
    : end_time_(end_time)
  {
    std::vector<Time> all = {{0., {true, false}}};
    for (const double time : snapshots)
      all.push_back({time, {true, false}});
    for (const double time : rows)
      all.push_back({time, {false, true}});
    std::stable_sort(all.begin(), all.end(), [](const Time &a, const Time &b) { return a.value < b.value; });
    for (const Time &time : all)
      if (times_.empty() || time.value - times_.back().value > same_time * end_time)
        times_.push_back(time);
      else
      {
        Time &other = times_.back();
        if (time.kinds.is_snapshot) // keep its exact time
          other.value = time.value;
        other.kinds = {other.kinds.is_snapshot || time.kinds.is_snapshot, other.kinds.is_row || time.kinds.is_row};
      }
  }

  std::size_t
  PictureTimes::n_snapshots() const
  {
    const auto n = std::count_if(times_.begin(), times_.end(), [](const Time &time) { return time.kinds.is_snapshot; });
    return n > 0 ? static_cast<std::size_t>(n) - 1 : 0;
  }

  PictureTimes
  picture_times(const OutputParameters &output, const Scene &scene)
  {
    if (!output.has_snapshots())
      return {};
    const double T       = scene.end_time;
    const auto gait      = scene.active_stress->repetition();
    const double strides = gait ? T / gait->period : strides_if_unknown;
    const auto in_all    = [](const double n_strides) {
      return static_cast<unsigned int>(std::ceil(per_stride * n_strides - 1e-6));
    };
    const auto snapshots =
      equal_parts(0., T, output.n_snapshots.value_or(in_all(std::clamp(strides, 1., 1. * max_snapshots / per_stride))));
    if (!output.kymograph)
      return {snapshots, {}, T};
    const bool is_long       = strides > max_strides;
    const double from        = is_long ? T - max_strides * gait->period : 0.;
    std::vector<double> rows = equal_parts(from, T, std::max(min_rows, in_all(std::min(strides, 1. * max_strides))));
    if (is_long)
      rows.erase(rows.begin());
    std::vector<double> jumps;
    const TimeSegments segments(*scene.active_stress, T);
    for (const double part : segments.breaks())
      if (part * T > from)
        jumps.push_back(part * T);
    if (jumps.size() <= max_jumps)
      rows.insert(rows.end(), jumps.begin(), jumps.end());
    std::sort(rows.begin(), rows.end());
    return {snapshots, rows, T};
  }
} // namespace crawler
