// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/grid_samples.h>
#include <crawler/scene/fast_changes.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

namespace crawler
{
  namespace
  {
    /// Multiple of the rate at a point of the box up to which that rate explains a bound.
    constexpr double explained_by_point = 16.;
    /// Changes below this fraction of the largest |m| are ignored.
    constexpr double negligible = 1e-4;
    /// Largest change of m in a listed time, in units of the largest |m|; longer times are halved.
    constexpr double max_changes = 64.;
    /// Shortest time of a box, relative to the duration.
    constexpr double shortest = 1e-9;

    struct Search
    {
      struct Part
      {
        ActiveStress::Box box;
        double bound;
        bool in_s; ///< the box is a half in s
      };

      const ActiveStress &stress;
      const double duration;
      const std::function<double(double, double)> &explained;
      const FastChangeLimits limits;
      double &largest_m;
      std::deque<Part> boxes = {};
      unsigned int n_bounds  = 0;

      FastChanges
      look(const ActiveStress::Box &all)
      {
        FastChanges result;
        const auto bounds = stress.bounds(all);
        if (!bounds)
          return result;
        boxes.push_back({all, bounds->rate, /*in_s=*/true});
        for (; !boxes.empty() && n_bounds < limits.max_bounds; boxes.pop_front())
          look_at(boxes.front(), result.list);
        result.is_complete = boxes.empty();
        for (const Part &part : boxes)
          result.list.push_back({part.box.t_from, part.box.t_to, std::min(part.bound, rate_in(part.box))});
        std::ranges::sort(result.list, {}, &FastChange::from);
        return result;
      }

      void
      look_at(const Part &part, std::vector<FastChange> &list)
      {
        const ActiveStress::Box box = part.box;
        const double bound = part.bound, time = box.t_to - box.t_from;
        const double admitted = explained(box.t_from, box.t_to);
        if (bound <= admitted || bound * time <= negligible * largest_m)
          return;
        const double rate = rate_in(box);
        if (rate * explained_by_point >= bound && 2. * rate > admitted && std::isfinite(bound))
        {
          see_values(box);
          if (bound * time <= max_changes * largest_m)
          {
            list.push_back({box.t_from, box.t_to, std::min(bound, 2. * rate)});
            return;
          }
        }
        if (time <= shortest * duration)
        {
          if (const double change = see_values(box); change >= limits.min_jump * largest_m && change > 0.)
            list.push_back({box.t_from, box.t_to, change / time});
          return;
        }
        // Halving goes in the direction with the smaller bounds; if they are equal, not in that of the last time.
        ActiveStress::Box left = box, right = box, early = box, late = box;
        left.s_to = right.s_from = 0.5 * (box.s_from + box.s_to);
        early.t_to = late.t_from = 0.5 * (box.t_from + box.t_to);
        const double of_early = bound_in(early), of_late = bound_in(late);
        const bool is_jump   = !std::isfinite(bound);
        const double of_left = is_jump ? HUGE_VAL : bound_in(left), of_right = is_jump ? HUGE_VAL : bound_in(right);
        const double in_time = of_early + of_late, in_space = of_left + of_right;
        const bool in_s = !is_jump && (in_space < 0.99 * in_time || (in_space <= 1.01 * in_time && !part.in_s));
        boxes.push_back(in_s ? Part{left, of_left, true} : Part{early, of_early, false});
        boxes.push_back(in_s ? Part{right, of_right, true} : Part{late, of_late, false});
      }

      double
      bound_in(const ActiveStress::Box &box)
      {
        ++n_bounds;
        return stress.bounds(box)->rate;
      }

      /// Largest |m_t| at some points of the box, where bounds are not too large.
      double
      rate_in(const ActiveStress::Box &box)
      {
        constexpr std::pair<double, double> points[] = {{0.5, 0.5}, {0.21, 0.83}, {0.79, 0.17}};
        double largest                               = 0.;
        for (const auto &[x, y] : points)
        {
          const double s = box.s_from + x * (box.s_to - box.s_from), t = box.t_from + y * (box.t_to - box.t_from);
          if (const double rate = bound_in({s, s, t, t}); std::isfinite(rate))
            largest = std::max(largest, rate);
        }
        return largest;
      }

      /// Updates the largest |m| by samples in the box, and returns the largest change of m.
      double
      see_values(const ActiveStress::Box &box)
      {
        constexpr unsigned int n = 4;
        std::vector<double> m(n + 1), least(n + 1, HUGE_VAL), most(n + 1, -HUGE_VAL);
        const auto at = stress.at(equal_parts(box.s_from, box.s_to, n));
        double change = 0.;
        for (const double t : equal_parts(box.t_from, box.t_to, n))
        {
          at->values(t, m);
          for (unsigned int i = 0; i <= n; ++i)
          {
            largest_m = std::max(largest_m, std::abs(m[i]));
            least[i]  = std::min(least[i], m[i]);
            most[i]   = std::max(most[i], m[i]);
            change    = std::max(change, most[i] - least[i]);
          }
        }
        return change;
      }
    };
  } // namespace

  FastChanges
  find_fast_changes(const ActiveStress &stress,
                    const double length,
                    const double from,
                    const double to,
                    const std::function<double(double, double)> &explained,
                    double &largest,
                    const FastChangeLimits &limits)
  {
    return Search{stress, to - from, explained, limits, largest}.look({0., length, from, to});
  }

  ActiveStress::Bounds
  sampled_bounds(const ActiveStress &stress,
                 const ActiveStress::Box &box,
                 const unsigned int n_s,
                 const unsigned int n_t)
  {
    const std::vector<double> places = equal_parts(box.s_from, box.s_to, n_s - 1);
    const auto at = stress.at(places), rate_at = stress.rate_at(places);
    const double step = (box.t_to - box.t_from) / (n_t - 1);
    std::vector<double> before, now(n_s), rates(n_s);
    ActiveStress::Bounds largest{0., 0.};
    for (const double t : equal_parts(box.t_from, box.t_to, n_t - 1))
    {
      at->values(t, now);
      if (rate_at)
        rate_at->values(t, rates);
      for (unsigned int i = 0; i < n_s; ++i)
      {
        if (!rate_at && !before.empty() && step > 0.)
          rates[i] = (now[i] - before[i]) / step;
        largest = {std::max(largest.value, std::abs(now[i])), std::max(largest.rate, std::abs(rates[i]))};
      }
      before = now;
    }
    return largest;
  }
} // namespace crawler
