// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/reference_element.h>

#include <cmath>
#include <span>

namespace crawler
{
  /// Evaluates the strain w - 1 of both formulations at fixed places of a cell.
  class StretchSampler
  {
  public:
    /// @param places from 0 (left end of the cell) to 1.
    StretchSampler(const ReferenceElement &element, const std::vector<double> &places)
      : places_(places)
      , n_(element.n)
      , q_(element.degree)
      , derivatives_(interpolation_matrix(element.nodes, places, 1))
      , from_stretch_points_(interpolation_matrix(element.stretch_points, places))
    {
    }

    const std::vector<double> &
    places() const
    {
      return places_;
    }

    /// The strain at place @p i of the local cell @p c of size @p h. @p u are the local displacements, @p log_w
    /// [cell][q] the logarithms of the stretch, empty in the position form.
    double
    strain(const std::span<const double> u,
           const std::span<const double> log_w,
           const unsigned int c,
           const double h,
           const unsigned int i) const
    {
      double sum = 0.;
      if (log_w.empty())
      {
        for (unsigned int j = 0; j < n_; ++j)
          sum += derivatives_[i * n_ + j] * u[c * q_ + j];
        return sum / h;
      }
      for (unsigned int p = 0; p < q_; ++p)
        sum += from_stretch_points_[i * q_ + p] * log_w[c * q_ + p];
      return std::expm1(sum);
    }

    /// The stretch, which keeps its digits when it is small in the log-stretch form.
    double
    stretch(const std::span<const double> u,
            const std::span<const double> log_w,
            const unsigned int c,
            const double h,
            const unsigned int i) const
    {
      if (log_w.empty())
        return 1. + strain(u, log_w, c, h, i);
      double sum = 0.;
      for (unsigned int p = 0; p < q_; ++p)
        sum += from_stretch_points_[i * q_ + p] * log_w[c * q_ + p];
      return std::exp(sum);
    }

  private:
    std::vector<double> places_;
    unsigned int n_, q_;
    std::vector<double> derivatives_;         ///< [place][n nodes]
    std::vector<double> from_stretch_points_; ///< [place][q]
  };
} // namespace crawler
