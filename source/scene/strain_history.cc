// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/gauss_panels.h>
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

  std::optional<StrainJump>
  find_jump(const StrainHistory &history, const double length, const double end_time)
  {
    constexpr unsigned int n_points = 11, n_intervals = 37, most_panels = 1024;
    constexpr double tolerance = 1e-6;
    std::vector<double> points(n_points), before(n_points), after(n_points), rate(n_points);
    for (unsigned int i = 0; i < n_points; ++i)
      points[i] = length * i / (n_points - 1);
    const auto at = history.at(points);
    double size   = 0.;
    for (unsigned int j = 0; j <= n_intervals; ++j)
    {
      at->strain(end_time * j / n_intervals, after);
      for (const double e : after)
        size = std::max(size, std::abs(e));
    }
    at->strain(0., after);
    for (unsigned int j = 0; j < n_intervals; ++j)
    {
      const double from = end_time * j / n_intervals, to = end_time * (j + 1) / n_intervals;
      before = after;
      at->strain(to, after);
      std::optional<StrainJump> jump;
      for (unsigned int n_panels = 1; n_panels == 1 || (jump && n_panels <= most_panels); n_panels *= 4)
      {
        const GaussPanels time(from, to, n_panels);
        std::vector<double> integral(n_points, 0.);
        for (std::size_t k = 0; k < time.points().size(); ++k)
        {
          at->rate(time.points()[k], rate);
          for (unsigned int i = 0; i < n_points; ++i)
            integral[i] += time.weights()[k] * rate[i];
        }
        jump.reset();
        for (unsigned int i = 0; i < n_points; ++i)
          if (!(std::abs(after[i] - before[i] - integral[i]) <= tolerance * size))
            jump = {points[i], from, to, after[i] - before[i], integral[i]};
      }
      if (jump)
        return jump;
    }
    return std::nullopt;
  }
} // namespace crawler
