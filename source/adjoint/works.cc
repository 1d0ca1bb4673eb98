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
  ForcesOfScene::evaluate(const double end, const StateAtPoints &at, const StateAtPoints &at_ends)
  {
    inside.evaluate(end, at);
    ends.evaluate(end, at_ends);
  }

  double
  work_rate(const Quantity work,
            const CellPoints &cells,
            const ForcesOfScene &forces,
            const StateAtPoints &at,
            const StateAtPoints &at_ends)
  {
    double sum = 0.;
    for (std::size_t p = 0; p < cells.size(); ++p)
    {
      const double ds = cells.weight(p), power = equation::stress_power(forces.inside.stress(p), at.rate[p]);
      sum += ds * (work == Quantity::dissipation     ? forces.inside.friction(p) * at.v[p]
                   : work == Quantity::positive_work ? std::max(power, 0.)
                                                     : power);
    }
    if (work == Quantity::paper_energy)
      sum += forces.ends.stress(1) * at_ends.v[1] - forces.ends.stress(0) * at_ends.v[0];
    return sum;
  }

  void
  add_slopes_of_work(const Quantity work,
                     const double weight,
                     const CellPoints &cells,
                     ForcesOfScene &forces,
                     const StateAtPoints &at,
                     const std::size_t n_nodes,
                     double *const by_u,
                     double *const by_v)
  {
    const std::vector<ForcesAtPoints::Slopes> slopes = forces.inside.slopes();
    StateAtPoints by(cells.size());
    for (std::size_t p = 0; p < cells.size(); ++p)
    {
      const double ds = weight * cells.weight(p), m = forces.inside.stress(p);
      const auto &slope = slopes[p];
      if (work == Quantity::dissipation)
      {
        by.u[p] = ds * slope.f_u * at.v[p];
        by.e[p] = ds * slope.f_w * at.v[p];
        by.v[p] = ds * (slope.f_v * at.v[p] + forces.inside.friction(p));
      }
      else if (work != Quantity::positive_work || equation::stress_power(m, at.rate[p]) > 0.)
      {
        by.e[p]    = -ds * slope.m_w * at.rate[p];
        by.rate[p] = -ds * (slope.m_rate * at.rate[p] + m);
      }
    }
    cells.add_to_nodes(by.u, by.e, by_u);
    cells.add_to_nodes(by.v, by.rate, by_v);
    if (work == Quantity::paper_energy)
    {
      by_v[0] -= weight * forces.ends.stress(0);
      by_v[n_nodes - 1] += weight * forces.ends.stress(1);
    }
  }
} // namespace crawler
