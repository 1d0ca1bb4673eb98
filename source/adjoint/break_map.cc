// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/break_map.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace crawler
{
  std::vector<double>
  breaks_in_space_of(const Scene &scene)
  {
    std::vector<double> list = scene.breaks_in_space();
    for (double &place : list)
      place /= scene.body.length;
    return list;
  }

  std::vector<double>
  breaks_in_time_of(const Scene &scene)
  {
    return TimeSegments(*scene.active_stress, scene.end_time).breaks();
  }

  BreakMap::BreakMap(const std::vector<double> &from, const std::vector<double> &to)
    : from_{0.}
    , to_{0.}
  {
    constexpr double near = 0.4;
    from_.insert(from_.end(), from.begin(), from.end());
    from_.push_back(1.);
    bunches_.resize(from_.size());
    for (const double x : to)
    {
      const auto right   = std::upper_bound(from_.begin() + 1, from_.end() - 1, x);
      const auto nearest = x - *(right - 1) < *right - x ? right - 1 : right;
      bunches_[static_cast<std::size_t>(nearest - from_.begin())].push_back(x);
      is_good_ = is_good_ && std::abs(x - *nearest) <= near * (*right - *(right - 1));
    }
    for (std::size_t i = 1; i + 1 < from_.size(); ++i)
    {
      const std::vector<double> &bunch = bunches_[i];
      is_good_                         = is_good_ && !bunch.empty();
      to_.push_back(std::accumulate(bunch.begin(), bunch.end(), 0.) / static_cast<double>(bunch.size()));
    }
    to_.push_back(1.);
  }

  bool
  BreakMap::is_one_to_one() const
  {
    return is_good_ && std::ranges::all_of(bunches_, [](const auto &bunch) { return bunch.size() <= 1; }) &&
           bunches_.front().empty() && bunches_.back().empty();
  }

  std::size_t
  BreakMap::piece(const double x) const
  {
    const auto right = std::lower_bound(from_.begin() + 1, from_.end() - 1, x - min_time_between_breaks);
    return static_cast<std::size_t>(right - from_.begin()) - 1;
  }

  double
  BreakMap::slope(const std::size_t piece) const
  {
    return (to_[piece + 1] - to_[piece]) / (from_[piece + 1] - from_[piece]);
  }

  double
  BreakMap::operator()(const std::size_t piece, const double x) const
  {
    return to_[piece] + slope(piece) * (x - from_[piece]);
  }

  std::size_t
  BreakMap::image(const std::size_t piece) const
  {
    std::size_t n = 0;
    for (std::size_t i = 0; i <= piece; ++i)
      n += bunches_[i].size();
    return n;
  }
} // namespace crawler
