// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/reference_element.h>
#include <crawler/run/lane_sampler.h>

#include <algorithm>

namespace crawler
{
  LaneSampler::LaneSampler(const LaneSetup &setup, const unsigned int n_pieces)
    : setup_(setup)
    , shape_((n_pieces + 1) * (setup.degree + 1))
    , integral_(setup.n_cells * setup.degree + 1, 0.)
    , u_(integral_.size())
    , at_ends_(n_pieces + 1)
  {
    const ReferenceElement &element = reference_element(setup.degree);
    double left                     = 0.;
    unsigned int piece              = 0;
    for (unsigned int cell = 0; cell < setup.n_cells; ++cell)
    {
      const double right = left + setup.sizes[cell];
      for (unsigned int i = 0; i < element.n; ++i)
        integral_[cell * setup.degree + i] += setup.sizes[cell] * element.node_weights[i];
      for (; piece <= n_pieces; ++piece)
      {
        const double s = static_cast<double>(piece) / n_pieces;
        if (s > right && cell + 1 < setup.n_cells)
          break;
        cells_.push_back(cell);
        const auto shape = interpolation_matrix(element.nodes, {(s - left) / setup.sizes[cell]});
        for (unsigned int i = 0; i < element.n; ++i)
          shape_[i * at_ends_.size() + piece] = shape[i];
      }
      left = right;
    }
  }

  Recorder::BodySample
  LaneSampler::sample(const LaneStep &step, const double time)
  {
    state_within(step, setup_, time, u_);
    double mean = 0.;
    for (std::size_t d = 0; d < u_.size(); ++d)
      mean += integral_[d] * u_[d];
    const unsigned int nodes = setup_.degree + 1;
    const std::size_t n      = at_ends_.size();
    std::fill(at_ends_.begin(), at_ends_.end(), 0.);
    for (std::size_t from = 0, to = 0; from < n; from = to)
    {
      const double *const u = &u_[cells_[from] * setup_.degree];
      while (to < n && cells_[to] == cells_[from])
        ++to;
      for (unsigned int i = 0; i < nodes; ++i)
        for (std::size_t e = from; e < to; ++e)
          at_ends_[e] += shape_[i * n + e] * u[i];
    }
    return {at_ends_, mean};
  }
} // namespace crawler
