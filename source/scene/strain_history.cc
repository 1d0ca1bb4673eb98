// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/scene/strain_history.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Goes to better neighbours on a grid of 3 x 3 points that shrinks when there are none.
    StrainExtreme
    refined(const StrainHistory &history,
            const double length,
            const double end_time,
            StrainExtreme best,
            const double sign,
            double ds,
            double dt)
    {
      constexpr unsigned int most_moves = 60;
      constexpr double shrink = 0.5, smallest = 1e-4;
      const double stop = smallest * ds;
      for (unsigned int move = 0; move < most_moves && ds > stop; ++move)
      {
        const std::vector<double> points = {std::max(0., best.s - ds), best.s, std::min(length, best.s + ds)};
        const auto at                    = history.at(points);
        const StrainExtreme centre       = best;
        std::array<double, 3> e{};
        for (const double t : {std::max(0., centre.t - dt), centre.t, std::min(end_time, centre.t + dt)})
        {
          at->strain(t, e);
          for (unsigned int i = 0; i < 3; ++i)
            if (sign * e[i] < sign * best.strain)
              best = {e[i], points[i], t};
        }
        if (best.s == centre.s && best.t == centre.t)
        {
          ds *= shrink;
          dt *= shrink;
        }
      }
      return best;
    }
  } // namespace

  StrainExtremes
  find_extremes(const StrainHistory &history,
                const double length,
                const double end_time,
                const unsigned int n_s,
                const unsigned int n_t)
  {
    std::vector<double> points(n_s), e(n_s);
    for (unsigned int i = 0; i < n_s; ++i)
      points[i] = i + 1 == n_s ? length : length * i / (n_s - 1);
    const auto at = history.at(points);
    StrainExtremes extremes{{HUGE_VAL, 0., 0.}, {-HUGE_VAL, 0., 0.}};
    for (unsigned int j = 0; j < n_t; ++j)
    {
      const double t = j + 1 == n_t ? end_time : end_time * j / (n_t - 1);
      at->strain(t, e);
      for (unsigned int i = 0; i < n_s; ++i)
      {
        const StrainExtreme here{e[i], points[i], t};
        if (!std::isfinite(e[i]))
          return {here, here};
        if (e[i] < extremes.smallest.strain)
          extremes.smallest = here;
        if (e[i] > extremes.largest.strain)
          extremes.largest = here;
      }
    }
    const double ds = length / (n_s - 1), dt = end_time / (n_t - 1);
    return {refined(history, length, end_time, extremes.smallest, 1., ds, dt),
            refined(history, length, end_time, extremes.largest, -1., ds, dt)};
  }
} // namespace crawler
