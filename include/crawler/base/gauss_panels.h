// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace crawler
{
  /// Gauss-Legendre quadrature with eight points on each of several panels, and running integrals of the polynomials of
  /// degree 7 through a function's values at the points.
  class GaussPanels
  {
  public:
    static constexpr unsigned int n_points = 8; ///< of a panel

    /// Equal panels.
    GaussPanels(double left, double right, unsigned int n_panels);
    /// Panels with these ends, ascending.
    explicit GaussPanels(const std::vector<double> &ends);

    /// All points, panel by panel.
    const std::vector<double> &
    points() const
    {
      return points_;
    }

    /// All points, and then both ends.
    std::vector<double>
    points_and_ends() const;

    /// The weights of the points.
    const std::vector<double> &
    weights() const
    {
      return weights_;
    }

    std::size_t
    n_panels() const
    {
      return ends_.size() - 1;
    }

    /// Integral over all panels of a function with the values @p f at the points.
    double
    integral(std::span<const double> f) const;

    /// Integrals from the left end to each of the points.
    void
    running_integral(std::span<const double> f, std::span<double> result) const;

    /// The transpose of running_integral(): sum_i x_i (running integral of f)_i = sum_j result_j f_j.
    void
    running_integral_transposed(std::span<const double> x, std::span<double> result) const;

    /// The smallest number of equal panels on [0, 1] for which each of the places is an end of a panel; 1 if that would
    /// exceed @p most.
    static unsigned int
    number_ending_at(const std::vector<double> &places, unsigned int most);

    /// Ends of @p n panels of about equal size from 0 to @p length, or of some more, so that they end at all of the
    /// @p breaks in between, ascending.
    static std::vector<double>
    ends_at(const std::vector<double> &breaks, double length, unsigned int n);

    /// Integrals from the left end to given places, prepared once: then a few products for each.
    class Places
    {
    public:
      Places(const GaussPanels &panels, const std::vector<double> &places);

      void
      running_integral(std::span<const double> f, std::span<double> result) const;

    private:
      struct Place
      {
        std::size_t panel;
        double weights[n_points]; ///< of the points of this panel
      };

      const std::vector<double> panel_weights_;
      std::vector<Place> places_;
      mutable std::vector<double> before_; ///< integrals up to the panels
    };

  private:
    double
    size(const std::size_t panel) const
    {
      return ends_[panel + 1] - ends_[panel];
    }

    const std::vector<double> ends_;
    std::vector<double> points_, weights_;
  };
} // namespace crawler
