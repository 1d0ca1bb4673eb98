// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/drivers/stress_scales.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace crawler
{
  namespace
  {
    /// Is one of @p breaks (ascending) between @p from and @p to?
    bool
    any_between(const std::vector<double> &breaks, const double from, const double to)
    {
      const auto next = std::lower_bound(breaks.begin(), breaks.end(), from);
      return next != breaks.end() && *next <= to;
    }

    /// A place where m jumps by more than @p least at the time @p t, without being one of the breaks @p in_space: where
    /// the largest difference of neighbours of a sampling does not become smaller when the neighbours come closer.
    std::optional<double>
    undeclared_jump(const Scene &scene, const std::vector<double> &in_space, const double t, const double least)
    {
      constexpr unsigned int n = 512, n_bisections = 30;
      const double L = scene.body.length;
      std::vector<double> points(n + 1), m(n + 1);
      for (unsigned int i = 0; i <= n; ++i)
        points[i] = L * i / n;
      scene.active_stress->at(points)->values(t, m);
      double left = 0., right = 0., m_left = 0., m_right = 0.;
      for (unsigned int i = 0; i < n; ++i)
        if (std::abs(m[i + 1] - m[i]) > std::abs(m_right - m_left) && !any_between(in_space, points[i], points[i + 1]))
        {
          left    = points[i];
          right   = points[i + 1];
          m_left  = m[i];
          m_right = m[i + 1];
        }
      for (unsigned int i = 0; i < n_bisections && std::abs(m_right - m_left) > least; ++i)
      {
        const std::vector<double> middle = {0.5 * (left + right)};
        std::vector<double> m_middle(1);
        scene.active_stress->at(middle)->values(t, m_middle);
        const bool in_left           = std::abs(m_middle[0] - m_left) > std::abs(m_right - m_middle[0]);
        (in_left ? right : left)     = middle[0];
        (in_left ? m_right : m_left) = m_middle[0];
      }
      return std::abs(m_right - m_left) > least ? std::optional(0.5 * (left + right)) : std::nullopt;
    }

    /// Are there such jumps that are elsewhere at another time?
    bool
    jumps_that_move(const Scene &scene, const std::vector<double> &in_space, const double least)
    {
      constexpr unsigned int n_times = 8;
      constexpr double golden        = 0.6180339887498949; // no multiple of a period
      const double L = scene.body.length, beside = 1e-6 * L;
      struct Jump
      {
        double place, time;
      };
      const auto is_there = [&](const double place, const double t)
      {
        const std::vector<double> points = {std::max(0., place - beside), std::min(L, place + beside)};
        std::vector<double> m(2);
        scene.active_stress->at(points)->values(t, m);
        return std::abs(m[1] - m[0]) > 0.5 * least;
      };
      std::vector<Jump> jumps;
      for (unsigned int i = 1; i <= n_times; ++i)
      {
        const double t = scene.end_time * std::fmod(i * golden, 1.);
        if (const auto place = undeclared_jump(scene, in_space, t, least))
          jumps.push_back({*place, t});
      }
      for (std::size_t i = 1; i < jumps.size(); ++i)
        if (!is_there(jumps[i].place, jumps[i - 1].time) && !is_there(jumps[i - 1].place, jumps[i].time))
          return true;
      return false;
    }

    /// Is the active stress nearly 0 for more than a tenth of the time?
    bool
    is_often_quiet(const Scene &scene, const double largest)
    {
      constexpr unsigned int n = 128, n_places = 5;
      constexpr double quiet = 1e-6, often = 0.1;
      std::vector<double> places, m(n_places);
      for (unsigned int i = 0; i < n_places; ++i)
        places.push_back(scene.body.length * i / (n_places - 1));
      const auto stress    = scene.active_stress->at(places);
      unsigned int n_quiet = 0;
      for (unsigned int j = 0; j < n; ++j)
      {
        stress->values(scene.end_time * j / n, m);
        n_quiet += std::all_of(m.begin(),
                               m.end(),
                               [&](const double value)
                               {
                                 return std::abs(value) <= quiet * largest;
                               });
      }
      return n_quiet > often * n;
    }

    struct SuddenChange
    {
      double at_start, later;
    };

    /// The largest sudden changes of m at the ends and of its jumps at the breaks in space.
    SuddenChange
    largest_sudden_change(const Scene &scene, const std::vector<double> &in_space)
    {
      const double L = scene.body.length, T = scene.end_time, beside = 2. * least_space_between_breaks * L;
      std::vector<double> points = {0., L};
      for (const double s : in_space)
        points.insert(points.end(), {s - beside, s + beside});
      const auto stress = scene.active_stress->at(points);
      std::vector<double> m(points.size());
      const std::size_t n = 2 + in_space.size();
      std::vector<double> before(n, 0.), now(n);
      SuddenChange largest{0., 0.};
      const auto look = [&](const double t)
      {
        stress->values(t * T, m);
        now[0] = m[0];
        now[1] = m[1];
        for (std::size_t i = 0; i < in_space.size(); ++i)
          now[2 + i] = m[3 + 2 * i] - m[2 + 2 * i];
      };
      TimePieces pieces(*scene.active_stress, T);
      for (double start = 0.;; pieces.go_on())
      {
        look(pieces.inside(start));
        for (std::size_t i = 0; i < n; ++i)
        {
          double &known = start == 0. ? largest.at_start : largest.later;
          known         = std::max(known, std::abs(now[i] - before[i]));
        }
        if (pieces.is_last())
          return largest;
        start = pieces.end();
        look(pieces.inside(start));
        before = now;
      }
    }
  } // namespace

  StressScales
  stress_scales(const Scene &scene)
  {
    constexpr unsigned int fine = 512, coarse = 16, very_fine = 8192;
    constexpr double jump_part = 0.05; // smaller jumps, relative to the largest |m|, are not looked for
    const double L = scene.body.length, T = scene.end_time;
    const std::vector<double> in_space = breaks_in_space(*scene.active_stress, L),
                              in_time  = TimePieces(*scene.active_stress, T).breaks();
    double largest = 0., along = 0., over = 0.;
    const auto look = [&](const unsigned int n_points, const unsigned int n_times)
    {
      std::vector<double> points(n_points + 1), m(n_points + 1), before;
      for (unsigned int i = 0; i <= n_points; ++i)
        points[i] = L * i / n_points;
      const auto stress = scene.active_stress->at(points);
      for (unsigned int j = 0; j <= n_times; ++j)
      {
        before = m;
        stress->values(T * j / n_times, m);
        const bool goes_on = j > 0 && !any_between(in_time, (j - 1.) / n_times, 1. * j / n_times);
        for (unsigned int i = 0; i <= n_points; ++i)
        {
          largest = std::max(largest, std::abs(m[i]));
          if (i > 0 && !any_between(in_space, points[i - 1], points[i]))
            along = std::max(along, std::abs(m[i] - m[i - 1]) / (points[i] - points[i - 1]));
          if (goes_on)
            over = std::max(over, std::abs(m[i] - before[i]) * n_times / T);
        }
      }
    };
    look(fine, coarse);
    look(coarse, fine);
    if (is_often_quiet(scene, largest)) // and a short event may have been missed
      look(coarse, very_fine);
    const SuddenChange change = largest > 0. ? largest_sudden_change(scene, in_space) : SuddenChange{0., 0.};
    const double unit         = largest > 0. ? largest : 1.;
    const bool may_jump       = along * L / fine > jump_part * largest;
    return {std::min(largest * L / scene.body.elastic_modulus, largest * T / (L * scene.body.friction_coefficient)),
            along > 0. ? largest / along : L,
            over > 0. ? largest / over : T,
            std::max(change.at_start, change.later) / unit,
            change.later / unit,
            in_space.size(),
            in_time.size(),
            may_jump && jumps_that_move(scene, in_space, jump_part * largest)};
  }
} // namespace crawler
