// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/strain_places.h>

#include <algorithm>

namespace crawler
{
  StrainPlaces::StrainPlaces(const std::vector<Cell> &cells,
                             const ReferenceElement &element,
                             const std::vector<double> &points,
                             const double sensor_length)
    : n_(element.n)
    , n_cells_(sensor_length > 0. ? 2 : 1)
  {
    const double end = cells.back().left + cells.back().size;
    const auto add   = [&](const CellPlace place, const bool is_slope, const double factor) {
      first_nodes_.push_back(static_cast<std::size_t>(place.cell) * element.degree);
      for (const double weight : interpolation_matrix(element.nodes, {place.x}, is_slope))
        weights_.push_back(factor * weight);
    };
    for (const double s : points)
      if (n_cells_ == 1)
      {
        const CellPlace place = place_in(cells, s);
        add(place, /*is_slope=*/true, 1. / cells[place.cell].size);
      }
      else
      {
        const double left = std::max(std::min(s + 0.5 * sensor_length, end) - sensor_length, 0.);
        add(place_in(cells, std::min(left + sensor_length, end)), /*is_slope=*/false, 1. / sensor_length);
        add(place_in(cells, left), /*is_slope=*/false, -1. / sensor_length);
      }
  }

  /// The displacement may be many times as large as its differences along a sensor: these have less round-off.
  void
  StrainPlaces::evaluate(const std::span<const double> u, const std::span<double> strain) const
  {
    for_degree(n_ - 1, [&](const auto degree) {
      const double *weight = weights_.data();
      for (std::size_t i = 0; i < strain.size(); ++i)
      {
        const std::size_t *const first = &first_nodes_[i * n_cells_];
        double sum                     = 0.;
        for (std::size_t j = 0; j < n_cells_; ++j, weight += degree + 1)
          for (int p = 0; p <= degree; ++p)
            sum += weight[p] * (u[first[j] + p] - u[first[0]]);
        strain[i] = sum;
      }
    });
  }
} // namespace crawler
