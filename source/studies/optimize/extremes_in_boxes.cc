// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/parabola.h>
#include <crawler/studies/optimize/extremes_in_boxes.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr double boxes_of_stride = 8., most_strides = 4., most_times = 2560.;
    constexpr std::size_t reach = 2; ///< of a crest from one time to the next [points]

    /// A place and the value there.
    using Point = std::pair<double, double>;

    /// The largest value (@p sign 1) or the smallest on the parabola through three points, the middle one of which has
    /// it among these; the middle one itself if the vertex is not between them.
    Point
    sharpened(const double sign, const Point &before, const Point &middle, const Point &after)
    {
      if (!(sign * middle.second >= sign * before.second && sign * middle.second >= sign * after.second))
        return middle;
      const Point vertex =
        parabola_vertex(before.first, before.second, middle.first, middle.second, after.first, after.second);
      return vertex.first > before.first && vertex.first < after.first ? vertex : middle;
    }
  } // namespace

  ExtremesInBoxes::ExtremesInBoxes(const double strides)
    : n_time_(static_cast<std::size_t>(boxes_of_stride * std::clamp(std::ceil(strides), 1., most_strides)))
    , times_per_box_(static_cast<std::size_t>(std::clamp(
                       per_box_ * boxes_of_stride * strides, per_box_ * static_cast<double>(n_time_), most_times)) /
                     n_time_)
  {
  }

  std::vector<double>
  equal_parts(const std::size_t n)
  {
    std::vector<double> list;
    for (std::size_t i = 0; i <= n; ++i)
      list.push_back(static_cast<double>(i) / static_cast<double>(n));
    return list;
  }

  std::vector<double>
  ExtremesInBoxes::points() const
  {
    return equal_parts(n_space_ * per_box_);
  }

  std::vector<double>
  ExtremesInBoxes::times() const
  {
    return equal_parts(n_time_ * times_per_box_);
  }

  std::vector<StretchPlace>
  ExtremesInBoxes::find(const std::vector<double> &stretch) const
  {
    const std::size_t n = n_space_ * per_box_, m = n_time_ * times_per_box_;
    const auto at   = [&](const std::size_t i, const std::size_t j) { return stretch[j * (n + 1) + i]; };
    const double ds = 1. / static_cast<double>(n), dt = 1. / static_cast<double>(m);
    const auto point = [&](const std::size_t i, const std::size_t j) {
      return Point{static_cast<double>(i) * ds, at(i, j)};
    };
    // In each of three rows, which a crest may cross elsewhere, and then between these.
    const auto in_row = [&](const std::size_t i, const std::size_t j, const double sign) {
      std::size_t best = i;
      for (std::size_t k = std::max<std::size_t>(i, reach) - reach; k <= std::min(i + reach, n); ++k)
        if (sign * at(k, j) > sign * at(best, j))
          best = k;
      return best > 0 && best < n ? sharpened(sign, point(best - 1, j), point(best, j), point(best + 1, j))
                                  : point(best, j);
    };
    const auto sharpened_at = [&](const std::size_t i, const std::size_t j, const double sign) {
      const Point own = in_row(i, j, sign);
      const double t  = static_cast<double>(j) * dt;
      if (j == 0 || j == m)
        return StretchPlace{own.first, t, own.second};
      const Point before = in_row(i, j - 1, sign), after = in_row(i, j + 1, sign);
      const Point vertex = sharpened(sign, {t - dt, before.second}, {t, own.second}, {t + dt, after.second});
      const double part  = (vertex.first - t) / dt;
      return StretchPlace{
        std::lerp(own.first, part < 0. ? before.first : after.first, std::abs(part)), vertex.first, vertex.second};
    };
    std::vector<StretchPlace> list;
    for (std::size_t b = 0; b < n_time_; ++b)
      for (std::size_t a = 0; a < n_space_; ++a)
        for (const double sign : {-1., 1.})
        {
          std::size_t i = a * per_box_, j = b * times_per_box_;
          for (std::size_t t = b * times_per_box_; t <= (b + 1) * times_per_box_; ++t)
            for (std::size_t s = a * per_box_; s <= (a + 1) * per_box_; ++s)
              if (sign * at(s, t) > sign * at(i, j))
              {
                i = s;
                j = t;
              }
          list.push_back(sharpened_at(i, j, sign));
        }
    return list;
  }

  std::vector<StretchPlace>
  ExtremesInBoxes::place(const StretchPlace &smallest, const StretchPlace &largest) const
  {
    std::vector<StretchPlace> list(size(), {0., 0., 1.});
    const auto put = [&](const StretchPlace &one, const std::size_t which) {
      const auto number = [](const double part, const std::size_t n) {
        return std::min(static_cast<std::size_t>(std::max(part, 0.) * static_cast<double>(n)), n - 1);
      };
      list[2 * (number(one.t, n_time_) * n_space_ + number(one.s, n_space_)) + which] = one;
    };
    put(smallest, 0);
    put(largest, 1);
    return list;
  }
} // namespace crawler
