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
  {
    const double end   = cells.back().left + cells.back().size;
    const bool is_mean = sensor_length > 0.;
    const auto add     = [&](const double s, const double factor) {
      const CellPlace place = place_in(cells, s);
      first_nodes_.push_back(static_cast<std::size_t>(place.cell) * element.degree);
      for (const double weight : interpolation_matrix(element.nodes, {place.x}, /*derivative=*/!is_mean))
        weights_.push_back(weight * factor / (is_mean ? sensor_length : cells[place.cell].size));
    };
    for (const double s : points)
    {
      const double left = std::max(std::min(s + 0.5 * sensor_length, end) - sensor_length, 0.);
      add(is_mean ? std::min(left + sensor_length, end) : s, 1.);
      if (is_mean)
        add(left, -1.);
    }
  }

  void
  StrainPlaces::evaluate(const std::span<const double> u, const std::span<double> strain) const
  {
    const std::size_t n_cells = first_nodes_.size() / std::max<std::size_t>(strain.size(), 1); // of a point
    for_degree(n_ - 1, [&](const auto degree) {
      const double *weight = weights_.data();
      for (std::size_t i = 0; i < strain.size(); ++i)
      {
        double sum = 0.;
        for (std::size_t j = i * n_cells; j < (i + 1) * n_cells; ++j, weight += degree + 1)
          for (int p = 0; p <= degree; ++p)
            sum += weight[p] * u[first_nodes_[j] + p];
        strain[i] = sum;
      }
    });
  }
} // namespace crawler
