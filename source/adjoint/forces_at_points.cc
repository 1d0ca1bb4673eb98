// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/forces_at_points.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  ForcesAtPoints::ForcesAtPoints(const Scene &physical, const Scene &other, const std::vector<double> &points)
    : units(natural_units(physical))
    , segments_(*physical.active_stress, physical.end_time)
    , scene_(in_units(physical, units, &segments_))
    , in_time_(breaks_in_time_of(other), segments_.breaks())
    , at_(points.size())
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
    friction_.emplace(scene_, own);
  }

  void
  ForcesAtPoints::evaluate(const double end, const StateAtPoints &at)
  {
    const std::size_t piece = in_time_.piece(end);
    const double slower     = in_time_.slope(piece);
    at_.u                   = at.u;
    for (std::size_t p = 0; p < longer_.size(); ++p)
    {
      at_.v[p]    = at.v[p] / slower;
      at_.e[p]    = at.e[p] / longer_[p];
      at_.w[p]    = 1. + at_.e[p];
      at_.rate[p] = at.rate[p] / (longer_[p] * slower);
    }
    piece_ = in_time_.image(piece);
    at_.t  = in_time_(piece, at.t);
    go_to(piece_, at_.t);
    friction_->evaluate(at_.u, at_.v, at_.w);
  }

  std::vector<ForcesAtPoints::Slopes>
  ForcesAtPoints::slopes() const
  {
    std::vector<Slopes> all;
    for (std::size_t p = 0; p < longer_.size(); ++p)
      all.push_back({body_->by_w[p] - body_->k[p],
                     body_->by_rate.empty() ? 0. : body_->by_rate[p],
                     friction_->f_u[p],
                     friction_->w_dg[p] / at_.w[p] * friction_->sliding[p],
                     friction_->f_v[p]});
    return all;
  }

  std::vector<double>
  ForcesAtPoints::between(const double time, const bool start)
  {
    const std::size_t number         = start ? 0 : in_time_.piece(time) + 1;
    const std::vector<double> &edges = in_time_.bunches[number];
    const bool is_end                = !start && number + 1 == in_time_.from.size();
    if (edges.size() < (start || is_end ? 1 : 2) ||
        (!start && std::abs(time - in_time_.from[number]) > min_time_between_breaks))
      return {};
    const double middle    = in_time_.to[number];
    const std::size_t left = start ? 0 : in_time_.image(number - 1), right = left + edges.size();
    std::vector<double> sum(longer_.size(), 0.);
    const auto add = [&](const std::size_t piece, const double from, const double to) {
      if (!(to > from))
        return;
      const double t = 0.5 * (from + to);
      go_to(piece, t);
      for (std::size_t p = 0; p < sum.size(); ++p)
        sum[p] += (to - from) * body_->N[p];
      go_to(t < middle || is_end ? left : right, t);
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
    go_to(piece_, at_.t);
    return sum;
  }

  /// Goes to N at a time of a piece, or to the nearest time that the piece has.
  void
  ForcesAtPoints::go_to(const std::size_t piece, const double t)
  {
    segments_.restart();
    for (std::size_t i = 0; i < piece; ++i)
      segments_.go_on();
    body_->evaluate(segments_.inside(t), at_.e, {at_.w, at_.rate, {}, {}});
  }
} // namespace crawler
