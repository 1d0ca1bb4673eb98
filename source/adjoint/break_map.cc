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

  BreakMap::BreakMap(const std::vector<double> &one, const std::vector<double> &other)
    : from{0.}
    , to{0.}
  {
    constexpr double near = 0.4;
    from.insert(from.end(), one.begin(), one.end());
    from.push_back(1.);
    bunches.resize(from.size());
    for (const double x : other)
    {
      const auto right   = std::upper_bound(from.begin() + 1, from.end() - 1, x);
      const auto nearest = x - *(right - 1) < *right - x ? right - 1 : right;
      bunches[static_cast<std::size_t>(nearest - from.begin())].push_back(x);
      is_good = is_good && std::abs(x - *nearest) <= near * (*right - *(right - 1));
    }
    for (std::size_t i = 1; i + 1 < from.size(); ++i)
    {
      const std::vector<double> &bunch = bunches[i];
      is_good                          = is_good && !bunch.empty();
      to.push_back(std::accumulate(bunch.begin(), bunch.end(), 0.) / static_cast<double>(bunch.size()));
    }
    to.push_back(1.);
  }

  bool
  BreakMap::is_one_to_one() const
  {
    return is_good && std::ranges::all_of(bunches, [](const auto &bunch) { return bunch.size() <= 1; }) &&
           bunches.front().empty() && bunches.back().empty();
  }

  std::size_t
  BreakMap::piece(const double x) const
  {
    const auto right = std::lower_bound(from.begin() + 1, from.end() - 1, x - min_time_between_breaks);
    return static_cast<std::size_t>(right - from.begin()) - 1;
  }

  double
  BreakMap::slope(const std::size_t piece) const
  {
    return (to[piece + 1] - to[piece]) / (from[piece + 1] - from[piece]);
  }

  double
  BreakMap::operator()(const std::size_t piece, const double x) const
  {
    return to[piece] + slope(piece) * (x - from[piece]);
  }

  std::size_t
  BreakMap::image(const std::size_t piece) const
  {
    std::size_t n = 0;
    for (std::size_t i = 0; i <= piece; ++i)
      n += bunches[i].size();
    return n;
  }
} // namespace crawler
