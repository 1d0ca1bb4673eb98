// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/general_sampler.h>

namespace crawler
{
  namespace
  {
    template <typename Part>
    auto
    parts(const std::vector<CellPlace> &places, const Part &part)
    {
      std::vector<std::decay_t<decltype(part(CellPlace()))>> result;
      for (const CellPlace &place : places)
        result.push_back(part(place));
      return result;
    }

    std::vector<CellPlace>
    in_all_cells(const Discretization &d, const std::vector<double> &places)
    {
      std::vector<CellPlace> result;
      for (unsigned int c = 0; c < d.n_local_cells(); ++c)
        for (const double x : places)
          result.push_back({c, x});
      return result;
    }
  } // namespace

  GeneralSampler::GeneralSampler(const Assembler &assembler, const std::vector<CellPlace> &places)
    : GeneralSampler(assembler,
                     parts(places, [](const CellPlace &place) { return place.cell; }),
                     parts(places, [](const CellPlace &place) { return place.x; }),
                     parts(places, [&](const CellPlace &place) {
                       const Discretization &d = assembler.discretization();
                       return d.cell_left().empty() ? 0.
                                                    : d.cell_left()[place.cell] + place.x * d.cell_size()[place.cell];
                     }))
  {
  }

  GeneralSampler::GeneralSampler(const Assembler &assembler, const std::vector<double> &places)
    : GeneralSampler(assembler, in_all_cells(assembler.discretization(), places))
  {
  }

  std::unique_ptr<GeneralSampler>
  GeneralSampler::at_ends(const Assembler &assembler)
  {
    const unsigned int n_cells = assembler.discretization().n_local_cells();
    std::vector<CellPlace> places;
    if (n_cells > 0)
      places = {{0, 0.}, {n_cells - 1, 1.}};
    return std::make_unique<GeneralSampler>(assembler, places);
  }

  GeneralSampler::GeneralSampler(const Assembler &assembler,
                                 const std::vector<unsigned int> &cells,
                                 const std::vector<double> &places,
                                 const std::vector<double> &points)
    : assembler_(assembler)
    , cells_(cells)
    , stretch_(assembler.discretization().element(), places)
    , values_(interpolation_matrix(assembler.discretization().element().nodes, places))
    , derivatives_(interpolation_matrix(assembler.discretization().element().nodes, places, 1))
    , sliding_(assembler.scene(), points)
    , force_(assembler.scene(), points)
    , elsewhere_(assembler.scene(), assembler.discretization(), points)
    , friction_(points.size())
  {
    for (auto *field : {&u_, &v_, &e_, &w_, &rate_})
      field->resize(points.size());
  }

  void
  GeneralSampler::sample(const double t, const std::span<const double> y, const std::span<const double> v)
  {
    const Discretization &d = assembler_.discretization();
    const auto u_local      = d.to_local(assembler_.displacement(y), u_local_);
    const auto v_local      = d.to_local(v, v_local_);
    const auto cells        = assembler_.stretch(y);
    const unsigned int n = d.element().n, q = d.element().degree;
    for (std::size_t p = 0; p < cells_.size(); ++p)
    {
      const unsigned int c = cells_[p];
      const double h       = d.cell_size()[c];
      const auto place     = static_cast<unsigned int>(p);
      u_[p] = v_[p] = rate_[p] = 0.;
      for (unsigned int i = 0; i < n; ++i)
      {
        const std::size_t node = static_cast<std::size_t>(c) * q + i;
        u_[p] += values_[p * n + i] * u_local[node];
        v_[p] += values_[p * n + i] * v_local[node];
        rate_[p] += derivatives_[p * n + i] * v_local[node] / h;
      }
      e_[p] = stretch_.strain(u_local, c, h, place);
      w_[p] = cells.empty() ? 1. + e_[p] : cells[c];
    }
    elsewhere_.evaluate(t, assembler_.stretch_coefficients(y), assembler_.history());
    force_.evaluate(t, e_, {w_, rate_, elsewhere_.near, elsewhere_.delayed});
    sliding_.evaluate(u_, v_);
    assembler_.scene().friction->values(w_, friction_);
    for (std::size_t p = 0; p < cells_.size(); ++p)
      friction_[p] *= sliding_.force[p];
  }
} // namespace crawler
