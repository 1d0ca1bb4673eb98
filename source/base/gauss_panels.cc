// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/gauss_panels.h>
#include <crawler/base/grid_samples.h>

#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr unsigned int n = GaussPanels::n_points;

    /// Weights of the integral from 0 to x of the polynomial through the points.
    std::array<double, n>
    integral_weights(const std::array<double, n> &points, const std::array<double, n> &weights, const double x)
    {
      std::array<double, n> result{};
      for (unsigned int j = 0; j < n; ++j)
        for (unsigned int g = 0; g < n; ++g)
        {
          double lagrange = x * weights[g];
          for (unsigned int i = 0; i < n; ++i)
            if (i != j)
              lagrange *= (x * points[g] - points[i]) / (points[j] - points[i]);
          result[j] += lagrange;
        }
      return result;
    }

    /// The rule on [0, 1], and its running integrals to the points.
    struct Reference
    {
      std::array<double, n> points, weights;
      std::array<std::array<double, n>, n> running;

      Reference()
      {
        using Rule           = boost::math::quadrature::gauss<double, n>;
        const auto &abscissa = Rule::abscissa(), &weight = Rule::weights(); // for the right half of [-1, 1]
        for (unsigned int i = 0; i < n / 2; ++i)
        {
          points[n / 2 + i]      = 0.5 * (1. + abscissa[i]);
          points[n / 2 - 1 - i]  = 0.5 * (1. - abscissa[i]);
          weights[n / 2 + i]     = 0.5 * weight[i];
          weights[n / 2 - 1 - i] = 0.5 * weight[i];
        }
        for (unsigned int i = 0; i < n; ++i)
          running[i] = integral_weights(points, weights, points[i]);
      }
    };

    const Reference &
    reference()
    {
      static const Reference rule;
      return rule;
    }
  } // namespace

  GaussPanels::GaussPanels(const double left, const double right, const unsigned int n_panels)
    : GaussPanels(equal_parts(left, right, n_panels))
  {
  }

  GaussPanels::GaussPanels(const std::vector<double> &ends)
    : ends_(ends)
  {
    for (std::size_t p = 0; p < n_panels(); ++p)
      for (unsigned int i = 0; i < n; ++i)
      {
        points_.push_back(ends_[p] + reference().points[i] * size(p));
        weights_.push_back(reference().weights[i] * size(p));
      }
  }

  std::vector<double>
  GaussPanels::points_and_ends() const
  {
    std::vector<double> all = points_;
    all.insert(all.end(), {ends_.front(), ends_.back()});
    return all;
  }

  double
  GaussPanels::integral(const std::span<const double> f) const
  {
    double sum = 0.;
    for (std::size_t i = 0; i < weights_.size(); ++i)
      sum += weights_[i] * f[i];
    return sum;
  }

  void
  GaussPanels::running_integral(const std::span<const double> f, const std::span<double> result) const
  {
    double before = 0.;
    for (std::size_t first = 0; first < points_.size(); first += n)
    {
      for (unsigned int i = 0; i < n; ++i)
      {
        double sum = 0.;
        for (unsigned int j = 0; j < n; ++j)
          sum += reference().running[i][j] * f[first + j];
        result[first + i] = before + size(first / n) * sum;
      }
      for (unsigned int j = 0; j < n; ++j)
        before += weights_[first + j] * f[first + j];
    }
  }

  void
  GaussPanels::running_integral_transposed(const std::span<const double> x, const std::span<double> result) const
  {
    double later = 0.; // sum of x in the panels to the right
    for (std::size_t first = points_.size(); first > 0;)
    {
      first -= n;
      double own = 0.;
      for (unsigned int j = 0; j < n; ++j)
      {
        double sum = 0.;
        for (unsigned int i = 0; i < n; ++i)
          sum += reference().running[i][j] * x[first + i];
        result[first + j] = size(first / n) * sum + weights_[first + j] * later;
        own += x[first + j];
      }
      later += own;
    }
  }

  unsigned int
  GaussPanels::number_ending_at(const std::vector<double> &places, const unsigned int most)
  {
    constexpr double round_off = 1e-9;
    for (unsigned int n = 1; n <= most; ++n)
      if (std::ranges::all_of(places,
                              [n](const double x) { return std::abs(x * n - std::round(x * n)) < round_off * n; }))
        return n;
    return 1;
  }

  std::vector<double>
  GaussPanels::ends_at(const std::vector<double> &breaks, const double length, const unsigned int n)
  {
    std::vector<double> ends = {0.};
    const auto add_piece     = [&](const double end) {
      const double begin = ends.back();
      const double parts = std::ceil((end - begin) / length * n - 1e-6);
      for (const double part : equal_parts(begin, end, std::max(1u, static_cast<unsigned int>(parts))))
        if (part > ends.back())
          ends.push_back(part);
    };
    for (const double x : breaks)
      if (x > ends.back() && x < length)
        add_piece(x);
    add_piece(length);
    return ends;
  }

  GaussPanels::Places::Places(const GaussPanels &panels, const std::vector<double> &places)
    : panel_weights_(panels.weights_)
    , before_(panels.n_panels())
  {
    for (const double x : places)
    {
      const auto after = std::upper_bound(panels.ends_.begin() + 1, panels.ends_.end() - 1, x);
      const auto panel = static_cast<std::size_t>(after - panels.ends_.begin()) - 1;
      Place place{panel, {}};
      const auto weights =
        integral_weights(reference().points, reference().weights, (x - panels.ends_[panel]) / panels.size(panel));
      for (unsigned int j = 0; j < n; ++j)
        place.weights[j] = panels.size(panel) * weights[j];
      places_.push_back(place);
    }
  }

  void
  GaussPanels::Places::running_integral(const std::span<const double> f, const std::span<double> result) const
  {
    double sum = 0.;
    for (std::size_t p = 0; p < before_.size(); ++p)
    {
      before_[p] = sum;
      for (unsigned int j = 0; j < n; ++j)
        sum += panel_weights_[p * n + j] * f[p * n + j];
    }
    for (std::size_t i = 0; i < places_.size(); ++i)
    {
      const Place &place = places_[i];
      double integral    = before_[place.panel];
      for (unsigned int j = 0; j < n; ++j)
        integral += place.weights[j] * f[place.panel * n + j];
      result[i] = integral;
    }
  }
} // namespace crawler
