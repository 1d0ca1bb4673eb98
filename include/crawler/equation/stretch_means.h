// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/discretization.h>

#include <span>
#include <vector>

namespace crawler
{
  /**
   * Means over pieces of one length of the body of a field that has one value at each stretch point of each cell of the
   * whole mesh [cell][q], a polynomial in each cell: for the strain (u(right) - u(left))/length.
   */
  class StretchMeans
  {
  public:
    /// @p middles [length]; pieces that extend beyond the body are moved inside. @p length is at most that of the body.
    StretchMeans(const std::vector<Cell> &cells,
                 const ReferenceElement &element,
                 const std::vector<double> &middles,
                 double length);

    /// Writes the @p means [middle] of @p field [cell][q].
    void
    mean(std::span<const double> field, std::span<double> means) const;

  private:
    /// Integrals from the left end of the body to fixed places: sums over the cells before, and weights in the cell.
    struct Integrals
    {
      std::vector<std::size_t> cells;
      std::vector<double> weights; ///< [place][q]
    };
    Integrals
    integrals_to(const std::vector<Cell> &cells,
                 const ReferenceElement &element,
                 const std::vector<double> &places) const;

    const unsigned int q_;
    const double length_;
    std::vector<double> cell_weights_; ///< [cell][q]
    Integrals left_, right_;
  };
} // namespace crawler
