// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/general_laws.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/scene/scene.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <vector>

namespace crawler
{
  /// A state at all quadrature points.
  struct StateAtPoints
  {
    std::vector<double> u, v, e, w, rate;

    explicit StateAtPoints(const std::size_t n)
      : u(n)
      , v(n)
      , e(n)
      , w(n)
      , rate(n)
    {
    }
  };

  /**
   * [0, 1] to [0, 1], linear between breaks and taking those of one scene to those of another, which are near them:
   * where several come together in the one, to the mean of what they are in the other.
   */
  class BreakMap
  {
  public:
    BreakMap(const std::vector<double> &from, const std::vector<double> &to)
      : from_{0.}
      , to_{0.}
      , bunches_(1)
    {
      constexpr double near = 0.4;
      for (const double x : from)
        from_.push_back(x);
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

    /// Has each break of the one some of the other near it, and the other no more but at the ends?
    bool
    is_good() const
    {
      return is_good_;
    }
    /// Are they as many?
    bool
    is_one_to_one() const
    {
      return is_good_ && std::ranges::all_of(bunches_, [](const auto &bunch) { return bunch.size() <= 1; }) &&
             bunches_.front().empty() && bunches_.back().empty();
    }

    /// The number of the piece in which @p x is; the left one at a break.
    std::size_t
    piece(const double x) const
    {
      const auto right = std::lower_bound(from_.begin() + 1, from_.end() - 1, x - 1e-12);
      return static_cast<std::size_t>(right - from_.begin()) - 1;
    }
    double
    slope(const std::size_t piece) const
    {
      return (to_[piece + 1] - to_[piece]) / (from_[piece + 1] - from_[piece]);
    }
    double
    operator()(const std::size_t piece, const double x) const
    {
      return to_[piece] + slope(piece) * (x - from_[piece]);
    }

    double
    start(const std::size_t piece) const
    {
      return from_[piece];
    }
    double
    end(const std::size_t piece) const
    {
      return from_[piece + 1];
    }
    bool
    is_last(const std::size_t piece) const
    {
      return piece + 2 == from_.size();
    }
    /// The breaks of the other scene near break @p number of the one; 0 is the start, and what they are taken for.
    const std::vector<double> &
    bunch(const std::size_t number) const
    {
      return bunches_[number];
    }
    double
    image_of_break(const std::size_t number) const
    {
      return to_[number];
    }
    /// The number of the piece of the other scene that this one becomes.
    std::size_t
    image(const std::size_t piece) const
    {
      std::size_t n = 0;
      for (std::size_t i = 0; i <= piece; ++i)
        n += bunches_[i].size();
      return n;
    }

  private:
    std::vector<double> from_, to_;
    std::vector<std::vector<double>> bunches_; ///< [break of the one, and both ends]
    bool is_good_ = true;
  };

  /// Of a scene, in units of its length.
  std::vector<double>
  breaks_in_space_of(const Scene &scene);

  /// In units of its duration.
  std::vector<double>
  breaks_in_time_of(const Scene &scene);

  /**
   * The force N in a body and the friction f at points, in natural units of the body. The state is that of another
   * scene at the points; its breaks are taken to those of this one: with S and R the stretches of the body and of the
   * time that this takes, w = 1 + e/S, v -> v/R, and a piece of the body is S times as long. What comes between jumps
   * in time that come together in the other scene is in between().
   */
  class ForcesAtPoints
  {
  public:
    ForcesAtPoints(const Scene &physical, const Scene &other, const std::vector<double> &points)
      : units_(natural_units(physical))
      , segments_(*physical.active_stress, physical.end_time)
      , scene_(in_units(physical, units_, &segments_))
      , in_time_(breaks_in_time_of(other), segments_.breaks())
      , at_(points.size())
      , g_(points.size())
    {
      const BreakMap in_space(breaks_in_space_of(other), breaks_in_space_of(physical));
      std::vector<double> own = points;
      for (double &s : own)
      {
        const std::size_t piece = in_space.piece(s);
        longer_.push_back(in_space.slope(piece));
        s = in_space(piece, s);
      }
      body_.emplace(scene_, own);
      sliding_.emplace(scene_, own);
    }

    const Units &
    units() const
    {
      return units_;
    }

    /// At the time @p t of a step that ends at @p end.
    void
    evaluate(const double t, const double end, const StateAtPoints &at)
    {
      const std::size_t piece = in_time_.piece(end);
      const double slower     = in_time_.slope(piece);
      at_.u                   = at.u;
      for (std::size_t p = 0; p < g_.size(); ++p)
      {
        at_.v[p]    = at.v[p] / slower;
        at_.e[p]    = at.e[p] / longer_[p];
        at_.w[p]    = 1. + at_.e[p];
        at_.rate[p] = at.rate[p] / (longer_[p] * slower);
      }
      force(in_time_.image(piece), in_time_(piece, t));
      sliding_->evaluate(at_.u, at_.v);
      scene_.friction->values(at_.w, g_);
    }

    /// Is the end of a step where several jumps come together, or where some come in or go out of the run? (@p start:
    /// of the run.)
    bool
    has_between(const double time, const bool start) const
    {
      const std::size_t number = start ? 0 : in_time_.piece(time) + 1;
      const bool is_edge       = start || in_time_.is_last(number - 1);
      return in_time_.bunch(number).size() >= (is_edge ? 1 : 2) &&
             (start || std::abs(time - in_time_.end(number - 1)) <= 1e-12);
    }

    /// int N dt over the short times between them, less what evaluate() has instead, at all points; for the state
    /// that was evaluated last.
    std::vector<double>
    between(const double time, const bool start)
    {
      const std::size_t number  = start ? 0 : in_time_.piece(time) + 1;
      std::vector<double> edges = in_time_.bunch(number);
      const double middle       = in_time_.image_of_break(number);
      const std::size_t left = start ? 0 : in_time_.image(number - 1), right = left + edges.size();
      const bool is_end = !start && in_time_.is_last(number - 1);
      std::vector<double> sum(g_.size(), 0.);
      const auto add = [&](const std::size_t piece, const double from, const double to) {
        if (!(to > from))
          return;
        const double t = 0.5 * (from + to);
        force(piece, t);
        for (std::size_t p = 0; p < sum.size(); ++p)
          sum[p] += (to - from) * body_->N[p];
        force(t < middle || is_end ? left : right, t);
        for (std::size_t p = 0; p < sum.size(); ++p)
          sum[p] -= (to - from) * body_->N[p];
      };
      if (start)
        add(left, 0., edges.front());
      for (std::size_t i = 0; i + 1 < edges.size(); ++i)
      {
        add(left + i + 1, edges[i], std::min(edges[i + 1], middle));
        add(left + i + 1, std::max(edges[i], middle), edges[i + 1]);
      }
      if (is_end)
        add(right, edges.back(), 1.);
      return sum;
    }

    double
    body_force(const std::size_t point) const
    {
      return body_->N[point];
    }
    /// For each length of the other body.
    double
    friction(const std::size_t point) const
    {
      return longer_[point] * g_[point] * sliding_->force[point];
    }
    double
    longer(const std::size_t point) const
    {
      return longer_[point];
    }
    double
    elastic(const std::size_t point, const double e) const
    {
      return body_->k[point] * e;
    }

  private:
    /// N at a time of a piece, or as near to it as the piece comes.
    void
    force(const std::size_t piece, const double t)
    {
      segments_.restart();
      for (std::size_t i = 0; i < piece; ++i)
        segments_.go_on();
      body_->evaluate(segments_.inside(t), at_.e, {at_.w, at_.rate, {}, {}});
    }

    const Units units_;
    TimeSegments segments_;
    const Scene scene_;
    const BreakMap in_time_;
    std::vector<double> longer_;
    std::optional<BodyForceAtPoints> body_;
    std::optional<SlidingAtPoints> sliding_;
    StateAtPoints at_;
    std::vector<double> g_;
  };

  /// A field, and its derivative by s, at all quadrature points from its values at the nodes.
  void
  evaluate_at_points(const LaneSetup &setup,
                     const double *nodal,
                     std::vector<double> &values,
                     std::vector<double> &slopes);
} // namespace crawler
