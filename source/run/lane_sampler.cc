// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/reference_element.h>
#include <crawler/run/lane_sampler.h>

#include <algorithm>

namespace crawler
{
  LaneSampler::LaneSampler(const LaneSetup &setup, const unsigned int n_pieces)
    : setup_(setup)
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
        shape_.insert(shape_.end(), shape.begin(), shape.end());
      }
      left = right;
    }
  }

  void
  LaneSampler::sample(const LaneStep &step, const double time)
  {
    state_within(step, setup_, time, u_);
    mean_ = 0.;
    for (std::size_t d = 0; d < u_.size(); ++d)
      mean_ += integral_[d] * u_[d];
    const unsigned int nodes = setup_.degree + 1;
    for (std::size_t e = 0; e < at_ends_.size(); ++e)
    {
      const double *const u = &u_[cells_[e] * setup_.degree];
      at_ends_[e]           = 0.;
      for (unsigned int i = 0; i < nodes; ++i)
        at_ends_[e] += shape_[e * nodes + i] * u[i];
    }
  }
} // namespace crawler
