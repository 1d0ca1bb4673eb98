// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/works.h>
#include <crawler/equation/crawler_equation.h>

#include <algorithm>

namespace crawler
{
  ForcesOfScene::ForcesOfScene(const Scene &physical, const Scene &other, const std::vector<double> &points)
    : inside(physical, other, points)
    , ends(physical, other, {0., 1.})
  {
  }

  void
  ForcesOfScene::evaluate(const double t, const double end, const StateAtPoints &at, const StateAtPoints &at_ends)
  {
    inside.evaluate(t, end, at);
    ends.evaluate(t, end, at_ends);
  }

  WorkRates::WorkRates(const CellPoints &points)
    : points_(points)
    , by_u_(points.size())
    , by_e_(points.size())
    , by_v_(points.size())
    , by_rate_(points.size())
  {
  }

  double
  WorkRates::rate(const Quantity work,
                  const ForcesOfScene &forces,
                  const StateAtPoints &at,
                  const StateAtPoints &at_ends) const
  {
    double sum = 0.;
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      const double ds = points_.weight(p), power = equation::stress_power(forces.inside.stress(p), at.rate[p]);
      sum += ds * (work == Quantity::dissipation     ? forces.inside.friction(p) * at.v[p]
                   : work == Quantity::positive_work ? std::max(power, 0.)
                                                     : power);
    }
    if (work == Quantity::paper_energy)
      sum += forces.ends.stress(1) * at_ends.v[1] - forces.ends.stress(0) * at_ends.v[0];
    return sum;
  }

  void
  WorkRates::add_slopes(const Quantity work,
                        const double weight,
                        const ForcesOfScene &forces,
                        const std::vector<ForcesAtPoints::Slopes> &slopes,
                        const StateAtPoints &at,
                        const std::size_t n_nodes,
                        double *const by_u,
                        double *const by_v)
  {
    for (std::size_t p = 0; p < points_.size(); ++p)
    {
      const double ds = weight * points_.weight(p), m = forces.inside.stress(p);
      const auto &slope = slopes[p];
      by_u_[p] = by_e_[p] = by_v_[p] = by_rate_[p] = 0.;
      if (work == Quantity::dissipation)
      {
        by_u_[p] = ds * slope.f_u * at.v[p];
        by_e_[p] = ds * slope.f_w * at.v[p];
        by_v_[p] = ds * (slope.f_v * at.v[p] + forces.inside.friction(p));
      }
      else if (work != Quantity::positive_work || equation::stress_power(m, at.rate[p]) > 0.)
      {
        by_e_[p]    = -ds * slope.m_w * at.rate[p];
        by_rate_[p] = -ds * (slope.m_rate * at.rate[p] + m);
      }
    }
    points_.add_to_nodes(by_u_, by_e_, by_u);
    points_.add_to_nodes(by_v_, by_rate_, by_v);
    if (work == Quantity::paper_energy)
    {
      by_v[0] -= weight * forces.ends.stress(0);
      by_v[n_nodes - 1] += weight * forces.ends.stress(1);
    }
  }
} // namespace crawler
