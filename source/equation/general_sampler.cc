// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/general_sampler.h>

namespace crawler
{
  GeneralSampler::GeneralSampler(const Assembler &assembler, const std::vector<CellPlace> &places)
    : friction(assembler.scene, assembler.discretization.points_of(places))
    , force(assembler.scene, assembler.discretization.points_of(places))
    , assembler_(assembler)
    , places_(places)
    , values_(interpolation_matrix(assembler.discretization.element.nodes, in_cells(places)))
    , derivatives_(interpolation_matrix(assembler.discretization.element.nodes, in_cells(places), /*derivative=*/true))
    , elsewhere_(assembler.scene, assembler.discretization, assembler.discretization.points_of(places))
  {
    for (auto *field : {&u_, &v_, &e_, &w_, &rate_})
      field->resize(places.size());
  }

  void
  GeneralSampler::sample(const double t, const std::span<const double> y, const std::span<const double> v)
  {
    const Discretization &d = assembler_.discretization;
    const auto u            = assembler_.displacement(y);
    const auto u_local      = d.to_local(u, u_local_);
    const auto v_local      = d.to_local(v, v_local_);
    const auto cells        = assembler_.stretch(y);
    const unsigned int n = d.element.n, q = d.element.degree;
    for (std::size_t p = 0; p < places_.size(); ++p)
    {
      const unsigned int c = places_[p].cell;
      const double h       = d.cell_size[c];
      u_[p] = v_[p] = rate_[p] = 0.;
      e_[p]                    = d.slope(u_local, c, &derivatives_[p * n]);
      for (unsigned int i = 0; i < n; ++i)
      {
        const std::size_t node = static_cast<std::size_t>(c) * q + i;
        u_[p] += values_[p * n + i] * u_local[node];
        v_[p] += values_[p * n + i] * v_local[node];
        rate_[p] += derivatives_[p * n + i] * v_local[node] / h;
      }
      w_[p] = cells.empty() ? 1. + e_[p] : cells[c];
    }
    elsewhere_.evaluate(t, u, assembler_.history);
    force.evaluate(t, e_, {w_, rate_, elsewhere_.near, elsewhere_.delayed});
    friction.evaluate(u_, v_, w_);
  }
} // namespace crawler
