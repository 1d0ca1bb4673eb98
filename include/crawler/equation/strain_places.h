// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/discretization.h>

#include <cstddef>
#include <span>
#include <vector>

namespace crawler
{
  /// Fixed places of the body where the strain is computed, or its mean over sensors of one length around them, which
  /// is (u(right) - u(left))/length.
  class StrainPlaces
  {
  public:
    /// @p points and @p sensor_length [length], at most that of the body; 0: no sensors. Points beyond the body stand
    /// for its end, and sensors that extend beyond it are moved inside.
    StrainPlaces(const std::vector<Cell> &cells,
                 const ReferenceElement &element,
                 const std::vector<double> &points,
                 double sensor_length = 0.);

    /// Writes the @p strain [point] of the displacement @p u [node of the whole mesh].
    void
    evaluate(std::span<const double> u, std::span<double> strain) const;

  private:
    unsigned int n_;                       ///< nodes of a cell
    std::size_t n_cells_;                  ///< cells that a point needs: 2 with sensors, else 1
    std::vector<std::size_t> first_nodes_; ///< [point][cell]
    std::vector<double> weights_;          ///< [point][cell][node]; those of a point add up to 0
  };
} // namespace crawler
