// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/gauss_panels.h>
#include <crawler/base/grid_samples.h>
#include <crawler/scene/fast_changes.h>
#include <crawler/scene/strain_extremes.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <utility>
#include <vector>

namespace crawler
{
  namespace
  {
    /// Moves to better neighbours on a grid of 3 x 3 points that shrinks when there are none.
    StrainExtreme
    refined(const ActiveStress &strain,
            const double length,
            const double end_time,
            StrainExtreme best,
            const double sign,
            double ds,
            double dt)
    {
      constexpr unsigned int max_moves = 60;
      constexpr double shrink = 0.5, smallest = 1e-4;
      const double stop = smallest * ds;
      for (unsigned int move = 0; move < max_moves && ds > stop; ++move)
      {
        const std::vector<double> points = {std::max(0., best.s - ds), best.s, std::min(length, best.s + ds)};
        const auto at                    = strain.at(points);
        const StrainExtreme centre       = best;
        std::array<double, 3> e{};
        for (const double t : {std::max(0., centre.t - dt), centre.t, std::min(end_time, centre.t + dt)})
        {
          at->values(t, e);
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

    /// Extremal points of a grid, @p n_s in each row, minima if @p sign > 0: the largest few, by parabolas through them
    /// and their neighbours.
    std::vector<std::size_t>
    peaks(const std::vector<double> &e, const std::size_t n_s, const double sign)
    {
      constexpr std::size_t most = 8;
      const std::size_t n_t      = e.size() / n_s;
      std::vector<std::pair<double, std::size_t>> list;
      const auto gain = [&](const double before, const double here, const double after) {
        const double slope = 0.5 * (after - before), curvature = sign * (after - 2. * here + before);
        return curvature > 0. ? 0.5 * slope * slope / curvature : 0.;
      };
      for (std::size_t j = 0; j < n_t; ++j)
        for (std::size_t i = 0; i < n_s; ++i)
        {
          const std::size_t k    = j * n_s + i;
          const std::size_t left = i > 0 ? k - 1 : k, right = i + 1 < n_s ? k + 1 : k;
          const std::size_t before = j > 0 ? k - n_s : k, after = j + 1 < n_t ? k + n_s : k;
          const auto is_beyond = [&](const std::size_t other) { return sign * e[other] < sign * e[k]; };
          if (!is_beyond(left) && !is_beyond(right) && !is_beyond(before) && !is_beyond(after))
            list.emplace_back(sign * e[k] - gain(e[left], e[k], e[right]) - gain(e[before], e[k], e[after]), k);
        }
      const auto end = list.begin() + static_cast<std::ptrdiff_t>(std::min(most, list.size()));
      std::partial_sort(list.begin(), end, list.end());
      std::vector<std::size_t> best;
      std::transform(list.begin(), end, std::back_inserter(best), [](const auto &one) { return one.second; });
      return best;
    }
  } // namespace

  StrainExtremes
  find_extremes(const ActiveStress &strain,
                const double length,
                const double end_time,
                const unsigned int n_s,
                const unsigned int n_t)
  {
    const std::vector<double> points = equal_parts(0., length, n_s - 1), times = equal_parts(0., end_time, n_t - 1);
    std::vector<double> e(1ul * n_s * n_t);
    const auto at = strain.at(points);
    for (unsigned int j = 0; j < n_t; ++j)
    {
      const std::span row(e.data() + 1ul * j * n_s, n_s);
      at->values(times[j], row);
      for (unsigned int i = 0; i < n_s; ++i)
        if (const StrainExtreme here{row[i], points[i], times[j]}; !std::isfinite(row[i]))
          return {here, here};
    }
    const double ds = length / (n_s - 1), dt = end_time / (n_t - 1);
    // Several peaks are refined: the highest shows only between the points of the grid.
    const auto extreme = [&](const double sign) {
      StrainExtreme best{sign * HUGE_VAL, 0., 0.};
      for (const std::size_t k : peaks(e, n_s, sign))
      {
        const StrainExtreme one =
          refined(strain, length, end_time, {e[k], points[k % n_s], times[k / n_s]}, sign, ds, dt);
        if (sign * one.strain < sign * best.strain)
          best = one;
      }
      return best;
    };
    return {extreme(1.), extreme(-1.)};
  }

  std::optional<StrainJump>
  find_jump(const ActiveStress &strain, const double length, const double end_time)
  {
    constexpr unsigned int n_points = 11, n_intervals = 37, max_panels = 1024;
    constexpr double tolerance = 1e-6;
    std::vector<double> before(n_points), after(n_points), rate(n_points);
    const std::vector<double> points = equal_parts(0., length, n_points - 1),
                              times  = equal_parts(0., end_time, n_intervals);
    const auto at = strain.at(points), rate_at = strain.rate_at(points);
    const double size = sampled_bounds(strain, {0., length, 0., end_time}, n_points, n_intervals + 1).value;
    at->values(0., after);
    for (unsigned int j = 0; j < n_intervals; ++j)
    {
      const double from = times[j], to = times[j + 1];
      before = after;
      at->values(to, after);
      std::optional<StrainJump> jump;
      double envelope = 0.; // largest difference times number of panels
      bool grows      = true;
      for (unsigned int n_panels = 1; n_panels == 1 || (jump && n_panels <= max_panels); n_panels *= 4)
      {
        const GaussPanels time(from, to, n_panels);
        std::vector<double> integral(n_points, 0.);
        for (std::size_t k = 0; k < time.points().size(); ++k)
        {
          rate_at->values(time.points()[k], rate);
          for (unsigned int i = 0; i < n_points; ++i)
            integral[i] += time.weights()[k] * rate[i];
        }
        jump.reset();
        double largest = 0.;
        for (unsigned int i = 0; i < n_points; ++i)
          if (const double difference = std::abs(after[i] - before[i] - integral[i]); !(difference <= tolerance * size))
          {
            jump    = {points[i], from, to, after[i] - before[i], integral[i]};
            largest = std::max(largest, std::isfinite(difference) ? difference : HUGE_VAL);
          }
        grows    = largest * n_panels > 2. * envelope;
        envelope = std::max(envelope, largest * n_panels);
      }
      if (jump && grows)
        return jump;
    }
    return std::nullopt;
  }
} // namespace crawler
