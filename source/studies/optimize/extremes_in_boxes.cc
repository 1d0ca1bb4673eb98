// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/grid_samples.h>
#include <crawler/base/parabola.h>
#include <crawler/studies/optimize/extremes_in_boxes.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr std::size_t n_space = 8, per_box = 16;
    constexpr double boxes_of_stride = 8., max_strides = 4., max_times = 2560.;
    constexpr std::size_t reach = 2; ///< shift of a crest from one time to the next [points]
    /// Distance within which neighbours are the two sides of a break.
    constexpr double beside = 1e-9;

    /// Place and the value there.
    using Point = std::pair<double, double>;

    /// Extremum (@p sign 1: largest, -1: smallest) of the parabola through three points, the middle one of which is the
    /// extreme one; the middle one itself if the vertex is not between them, or if a break is.
    Point
    sharpened(const double sign, const Point &before, const Point &middle, const Point &after)
    {
      const double left = middle.first - before.first, right = after.first - middle.first;
      if (std::min(left, right) < 4. * beside ||
          !(sign * middle.second >= sign * before.second && sign * middle.second >= sign * after.second))
        return middle;
      const Point vertex =
        parabola_vertex(before.first, before.second, middle.first, middle.second, after.first, after.second);
      return vertex.first > before.first && vertex.first < after.first ? vertex : middle;
    }

    /// Index range of the places in a part of n equal ones, both ends included.
    std::pair<std::size_t, std::size_t>
    inside(const std::vector<double> &places, const std::size_t part, const std::size_t n)
    {
      const double from = static_cast<double>(part) / static_cast<double>(n) - beside / 2.,
                   to   = static_cast<double>(part + 1) / static_cast<double>(n) + beside / 2.;
      return {static_cast<std::size_t>(std::ranges::lower_bound(places, from) - places.begin()),
              static_cast<std::size_t>(std::ranges::upper_bound(places, to) - places.begin())};
    }

    /// Fractions 0, 1/n, ... 1, and both sides of some breaks.
    std::vector<double>
    equal_parts_and_breaks(const unsigned int n, const std::vector<double> &breaks)
    {
      std::vector<double> list = equal_parts(0., 1., n);
      std::erase_if(list, [&](const double place) {
        return std::ranges::any_of(breaks, [&](const double one) { return std::abs(one - place) < 4. * beside; });
      });
      for (const double one : breaks)
        for (const double side : {one - beside, one + beside})
          if (side >= 0. && side <= 1.)
            list.push_back(side);
      std::ranges::sort(list);
      const auto are_one = [](const double a, const double b) { return b - a < beside / 2.; };
      list.erase(std::unique(list.begin(), list.end(), are_one), list.end());
      return list;
    }
  } // namespace

  std::size_t
  ExtremesInBoxes::boxes_in_time(const double strides)
  {
    return static_cast<std::size_t>(boxes_of_stride * std::clamp(std::ceil(strides), 1., max_strides));
  }

  ExtremesInBoxes::ExtremesInBoxes(const std::size_t n_time, const double strides, const Breaks &breaks)
    : points(equal_parts_and_breaks(n_space * per_box, breaks.in_space))
    , times(equal_parts_and_breaks(
        static_cast<unsigned int>(
          std::clamp(per_box * boxes_of_stride * strides, per_box * static_cast<double>(n_time), max_times)),
        breaks.in_time))
    , n_time_(n_time)
  {
  }

  /// Refines an extreme in each of three rows, since a crest may cross them at different points, and then between the
  /// rows.
  StretchPlace
  ExtremesInBoxes::sharpened_at(const std::vector<double> &stretch,
                                const std::size_t i,
                                const std::size_t j,
                                const double sign) const
  {
    const std::size_t n = points.size();
    const auto point    = [&](const std::size_t k, const std::size_t row) {
      return Point{points[k], stretch[row * n + k]};
    };
    const auto in_row = [&](const std::size_t row) {
      std::size_t best = i;
      for (std::size_t k = std::max(i, reach) - reach; k < std::min(i + reach + 1, n); ++k)
        if (sign * point(k, row).second > sign * point(best, row).second)
          best = k;
      return best > 0 && best + 1 < n ? sharpened(sign, point(best - 1, row), point(best, row), point(best + 1, row))
                                      : point(best, row);
    };
    const Point own = in_row(j);
    if (j == 0 || j + 1 == times.size())
      return {own.first, times[j], own.second};
    const Point before = in_row(j - 1), after = in_row(j + 1);
    const Point vertex =
      sharpened(sign, {times[j - 1], before.second}, {times[j], own.second}, {times[j + 1], after.second});
    const bool is_earlier = vertex.first < times[j];
    const double part     = std::abs((vertex.first - times[j]) / (times[is_earlier ? j - 1 : j + 1] - times[j]));
    return {std::lerp(own.first, is_earlier ? before.first : after.first, part), vertex.first, vertex.second};
  }

  std::vector<StretchPlace>
  ExtremesInBoxes::find(const std::vector<double> &stretch) const
  {
    std::vector<StretchPlace> list;
    for (std::size_t b = 0; b < n_time_; ++b)
      for (std::size_t a = 0; a < n_space; ++a)
      {
        const auto [first_s, end_s] = inside(points, a, n_space);
        const auto [first_t, end_t] = inside(times, b, n_time_);
        for (const double sign : {-1., 1.})
        {
          std::size_t i = first_s, j = first_t;
          for (std::size_t t = first_t; t < end_t; ++t)
            for (std::size_t s = first_s; s < end_s; ++s)
              if (sign * stretch[t * points.size() + s] > sign * stretch[j * points.size() + i])
              {
                i = s;
                j = t;
              }
          list.push_back(sharpened_at(stretch, i, j, sign));
        }
      }
    return list;
  }

  std::vector<StretchPlace>
  ExtremesInBoxes::place(const StretchPlace &smallest, const StretchPlace &largest) const
  {
    std::vector<StretchPlace> list(2 * n_space * n_time_, {0., 0., 1.});
    const auto put = [&](const StretchPlace &one, const std::size_t which) {
      const auto number = [](const double part, const std::size_t n) {
        return std::min(static_cast<std::size_t>(std::max(part, 0.) * static_cast<double>(n)), n - 1);
      };
      list[2 * (number(one.t, n_time_) * n_space + number(one.s, n_space)) + which] = one;
    };
    put(smallest, 0);
    put(largest, 1);
    return list;
  }
} // namespace crawler
