// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/cubic_spline.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/grid_samples.h>
#include <crawler/scene/active_stress/shape_function.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace crawler
{
  namespace
  {
    constexpr unsigned int high_degree = 15, low_degree = 3;
    constexpr double smallest = 1e-10;              ///< panel, relative to the initial length
    constexpr double tiny     = 1e-6;               ///< largest panel, likewise, that only a kink causes
    constexpr double accuracy = 1e-13, jump = 1e-3; ///< of the largest |V|
    constexpr std::size_t max_panels = 1000000;
  } // namespace

  /// Chebyshev coefficients of the polynomial through the values at u_j = -cos( pi (j + 1/2)/n ), n = degree + 1.
  std::vector<double>
  ShapeFunction::coefficients(const Function &function, const double left, const double right) const
  {
    constexpr double pi  = std::numbers::pi;
    const unsigned int n = degree_ + 1;
    std::vector<double> x(n), values(n), c(n, 0.);
    for (unsigned int j = 0; j < n; ++j)
      x[j] = 0.5 * (left + right) - 0.5 * (right - left) * std::cos(pi * (j + 0.5) / n);
    function(x, values);
    for (unsigned int k = 0; k < n; ++k)
    {
      for (unsigned int j = 0; j < n; ++j)
        c[k] += values[j] * std::cos(pi * k * (n - j - 0.5) / n);
      c[k] *= (k == 0 ? 1. : 2.) / n;
    }
    return c;
  }

  void
  ShapeFunction::add_panel(const double right, const std::span<const double> c)
  {
    const unsigned int n = degree_ + 1;
    const double half    = 0.5 * (right - left_.back());
    // Integrals: that of T_k is ( T_(k+1)/(k+1) - T_(k-1)/(k-1) )/2, that of T_0 is T_1, that of T_1 is T_2/4.
    std::vector<double> integral(n + 1, 0.);
    for (unsigned int k = 1; k <= n; ++k)
      integral[k] =
        half * (k == 1 ? c[0] - (n > 2 ? 0.5 * c[2] : 0.) : (c[k - 1] - (k + 1 < n ? c[k + 1] : 0.)) / (2. * k));
    // T_k is 1 at the right end of a panel, and (-1)^k at the left one.
    if (!integral_.empty())
      integral[0] = std::accumulate(integral_.end() - (n + 1), integral_.end(), 0.);
    for (unsigned int k = 1; k <= n; ++k)
      integral[0] += k % 2 == 1 ? integral[k] : -integral[k];
    left_.push_back(right);
    value_.insert(value_.end(), c.begin(), c.end());
    integral_.insert(integral_.end(), integral.begin(), integral.end());
  }

  ShapeFunction::ShapeFunction(
    const Function &function, const double from, const double to, const double size, const std::string &entry)
    : degree_(high_degree)
    , left_{from}
  {
    const auto n_panels = static_cast<std::size_t>(std::ceil((to - from) / size * (1. - 1e-12)));
    if (n_panels > max_panels)
      throw std::logic_error("too many panels from the beginning");
    const std::vector<double> ends = equal_parts(from, to, static_cast<unsigned int>(n_panels));
    // Largest |V|, and a check that it is finite.
    double largest = 0.;
    std::vector<double> values(8);
    for (std::size_t i = 0; i < n_panels; ++i)
    {
      const std::vector<double> x = equal_parts(ends[i], ends[i + 1], 7);
      function(x, values);
      for (unsigned int j = 0; j < 8; ++j)
      {
        if (!std::isfinite(values[j]))
          refuse(entry,
                 "the shape is {} at x = {:g}; a finite number is expected from {:g} to {:g}",
                 values[j],
                 x[j],
                 from,
                 to);
        largest = std::max(largest, std::abs(values[j]));
      }
    }
    double kink_panel = 0.;                                     // the smallest panel at the last kink
    std::vector<double> rights(ends.rbegin(), ends.rend() - 1); // right ends of pending panels, the leftmost last
    while (!rights.empty())
    {
      const double left = left_.back(), right = rights.back();
      const auto c = coefficients(function, left, right);
      double last = 0., variation = 0.;
      for (unsigned int k = 0; k <= degree_; ++k)
      {
        if (!std::isfinite(c[k]))
          refuse(entry, "the shape is not a finite number somewhere from x = {:g} to {:g}", left, right);
        variation += k > 0 ? std::abs(c[k]) : 0.;
        last = k + 3 > degree_ ? std::max(last, std::abs(c[k])) : last;
      }
      const bool is_smallest = right - left <= smallest * size;
      if (last > accuracy * largest && !is_smallest)
      {
        rights.push_back(0.5 * (left + right));
        if (left_.size() + rights.size() > max_panels)
          refuse(entry,
                 "the shape has more detail from x = {:g} to {:g} than a million polynomials of "
                 "degree {} can represent; a smoother one is expected",
                 from,
                 to,
                 degree_);
        continue;
      }
      if (is_smallest && variation > jump * largest)
        refuse(entry, "the shape jumps at x = {:g}; a continuous function is expected", left);
      if (right - left <= tiny * size) // only panels with a kink in or near them are so small
      {
        const bool is_next = !kinks_.empty() && left - kinks_.back() <= 10. * tiny * size;
        if (!is_next)
          kinks_.push_back(0.5 * (left + right));
        else if (right - left < kink_panel)
          kinks_.back() = 0.5 * (left + right);
        kink_panel = is_next ? std::min(kink_panel, right - left) : right - left;
      }
      add_panel(right, c);
      rights.pop_back();
    }
  }

  ShapeFunction::ShapeFunction(const std::vector<double> &x, const std::vector<double> &f)
    : degree_(low_degree)
    , left_{x.front()}
  {
    const CubicSpline spline(x);
    const auto M            = spline.curvatures(f);
    const Function function = [&](const std::span<const double> places, const std::span<double> values) {
      for (std::size_t j = 0; j < places.size(); ++j)
        values[j] = spline.place(places[j]).value(f, M);
    };
    for (std::size_t i = 0; i + 1 < x.size(); ++i)
      add_panel(x[i + 1], coefficients(function, x[i], x[i + 1]));
  }

  std::size_t
  ShapeFunction::find(const double x, std::size_t panel) const
  {
    if (x < left_[panel])
    {
      const auto above = std::upper_bound(left_.begin() + 1, left_.end() - 1, x);
      return static_cast<std::size_t>(above - left_.begin()) - 1;
    }
    // Stepping a few panels is faster than a search.
    for (unsigned int step = 0; step < 8; ++step, ++panel)
      if (panel + 2 == left_.size() || x < left_[panel + 1])
        return panel;
    const auto above = std::upper_bound(left_.begin() + static_cast<std::ptrdiff_t>(panel), left_.end() - 1, x);
    return static_cast<std::size_t>(above - left_.begin()) - 1;
  }

  void
  ShapeFunction::values_and_integrals(const std::span<const double> x,
                                      std::size_t &panel,
                                      const std::span<double> values,
                                      const std::span<double> integrals) const
  {
    // Four places at a time: the recurrence of one waits for each of its results, those of four overlap.
    constexpr std::size_t n = 4;
    for (std::size_t first = 0; first < x.size(); first += n)
    {
      const double *c[n], *d[n];
      double u[n], T[n], T_next[n], value[n], integral[n];
      for (std::size_t j = 0; j < n; ++j)
      {
        const double place = x[std::min(first + j, x.size() - 1)];
        panel              = find(place, panel);
        u[j]               = local(place, panel);
        c[j]               = value_.data() + panel * (degree_ + 1);
        d[j]               = integral_.data() + panel * (degree_ + 2);
        T[j]               = 1.;
        T_next[j]          = u[j];
        value[j]           = c[j][0];
        integral[j]        = d[j][0];
      }
      for (unsigned int k = 1; k <= degree_; ++k)
        for (std::size_t j = 0; j < n; ++j)
        {
          value[j] += c[j][k] * T_next[j];
          integral[j] += d[j][k] * T_next[j];
          const double T_new = 2. * u[j] * T_next[j] - T[j];
          T[j]               = T_next[j];
          T_next[j]          = T_new;
        }
      for (std::size_t j = 0; j < n && first + j < x.size(); ++j)
      {
        values[first + j]    = value[j];
        integrals[first + j] = integral[j] + d[j][degree_ + 1] * T_next[j];
      }
    }
  }

  double
  ShapeFunction::derivative(const double x, std::size_t &panel) const
  {
    panel          = find(x, panel);
    const double u = local(x, panel), *c = value_.data() + panel * (degree_ + 1);
    // T_k' = k U_(k-1)
    double U = 0., U_next = 1., sum = 0.;
    for (unsigned int k = 1; k <= degree_; ++k)
    {
      sum += c[k] * k * U_next;
      const double U_new = 2. * u * U_next - U;
      U                  = U_next;
      U_next             = U_new;
    }
    return 2. * sum / (left_[panel + 1] - left_[panel]);
  }
} // namespace crawler
