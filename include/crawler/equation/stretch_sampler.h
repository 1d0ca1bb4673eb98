// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/reference_element.h>

#include <span>

namespace crawler
{
  /// Strain w - 1 of the position form at fixed places of a cell.
  class StretchSampler
  {
  public:
    /// @p places from 0 (left end of the cell) to 1.
    StretchSampler(const ReferenceElement &element, const std::vector<double> &places)
      : places(places)
      , n_(element.n)
      , q_(element.degree)
      , derivatives_(interpolation_matrix(element.nodes, places, /*derivative=*/true))
    {
    }

    const std::vector<double> places;

    /// Strain at place @p i of the local cell @p c of size @p h. @p u are the local displacements.
    double
    strain(const std::span<const double> u, const unsigned int c, const double h, const unsigned int i) const
    {
      double sum = 0.;
      for (unsigned int j = 0; j < n_; ++j)
        sum += derivatives_[i * n_ + j] * u[c * q_ + j];
      return sum / h;
    }

  private:
    unsigned int n_, q_;
    std::vector<double> derivatives_; ///< [place][n nodes]
  };
} // namespace crawler
