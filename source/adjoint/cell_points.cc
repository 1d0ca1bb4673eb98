// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/cell_points.h>
#include <crawler/base/gauss_rule.h>
#include <crawler/mesh/reference_element.h>
#include <crawler/time/radau_loops.h>

namespace crawler
{
  StateAtPoints::StateAtPoints(const std::size_t n)
    : u(n)
    , v(n)
    , e(n)
    , w(n)
    , rate(n)
  {
  }

  CellPoints::CellPoints(const LaneSetup &setup, const unsigned int n_more)
    : per_cell(setup.degree + 1 + n_more)
    , places(gauss_rule(static_cast<unsigned int>(per_cell)).points)
    , setup_(setup)
    , weights_(gauss_rule(static_cast<unsigned int>(per_cell)).weights)
    , values_(interpolation_matrix(reference_element(setup.degree).nodes, places))
    , slopes_(interpolation_matrix(reference_element(setup.degree).nodes, places, /*derivative=*/true))
  {
    double left = 0.;
    for (std::size_t c = 0; c < setup.n_cells; left += setup.sizes[c++])
      for (const double place : places)
        points.push_back(left + place * setup.sizes[c]);
  }

  double
  CellPoints::weight(const std::size_t point) const
  {
    return weights_[point % per_cell] * setup_.sizes[cell_of(point)];
  }

  void
  CellPoints::evaluate(const double *nodal, std::vector<double> &values, std::vector<double> &slopes) const
  {
    const std::size_t n = setup_.degree + 1;
    for (std::size_t c = 0; c < setup_.n_cells; ++c)
      for (std::size_t p = 0; p < per_cell; ++p)
      {
        double value = 0., slope = 0.;
        for (std::size_t i = 0; i < n; ++i)
        {
          value += values_[p * n + i] * nodal[c * setup_.degree + i];
          slope += slopes_[p * n + i] * nodal[c * setup_.degree + i];
        }
        values[c * per_cell + p] = value;
        slopes[c * per_cell + p] = slope / setup_.sizes[c];
      }
  }

  void
  CellPoints::add_to_nodes(const std::vector<double> &values, const std::vector<double> &slopes, double *nodal) const
  {
    const std::size_t n = setup_.degree + 1;
    for (std::size_t at = 0; at < size(); ++at)
    {
      const std::size_t c = cell_of(at), p = at % per_cell;
      for (std::size_t i = 0; i < n; ++i)
        nodal[c * setup_.degree + i] +=
          values[at] * values_[p * n + i] + slopes[at] * slopes_[p * n + i] / setup_.sizes[c];
    }
  }

  void
  CellPoints::evaluate(const BackwardStages &stages, StateAtPoints &at) const
  {
    at.t = stages.time;
    evaluate(stages.u.data(), at.u, at.e);
    evaluate(stages.v.data(), at.v, at.rate);
    for (std::size_t p = 0; p < size(); ++p)
      at.w[p] = 1. + at.e[p];
  }

  BackwardStages::BackwardStages(const LaneRecord &steps, const LaneSetup &setup)
    : u(steps.end)
    , v(steps.end.size())
    , steps_(steps)
    , setup_(setup)
    , y_(steps.end)
  {
  }

  void
  BackwardStages::go_back(const std::size_t step)
  {
    step_           = step;
    const double *z = steps_.z(step);
    for (std::size_t d = 0; d < y_.size(); ++d)
      y_[d] -= z[(setup_.n_stages - 1) * y_.size() + d];
  }

  void
  BackwardStages::go_to_stage(const unsigned int stage)
  {
    const double *z = steps_.z(step_);
    for (std::size_t d = 0; d < y_.size(); ++d)
      u[d] = y_[d] + z[stage * y_.size() + d];
    radau::stage_rate(static_cast<int>(setup_.n_stages),
                      setup_.method.inverse,
                      static_cast<int>(stage),
                      1. / steps_.sizes[step_],
                      z,
                      static_cast<int>(y_.size()),
                      v.data());
    time = steps_.times[step_] - (1. - setup_.method.c[stage]) * steps_.sizes[step_];
  }
} // namespace crawler
