// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/bracketed_root.h>
#include <crawler/scene/active_stress/wave_roots.h>
#include <crawler/scene/body.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace crawler
{
  namespace
  {
    using std::numbers::pi;

    /// Largest number of waves that are ever listed.
    constexpr std::size_t max_roots = 100000;
    /// Number of waves up to which the list is complete.
    constexpr double few_roots = 2000;

    /// S(x) = sum P_n sin^2(pi n x).
    double
    sine_sum(const WaveShape &shape, const double x)
    {
      double sum = 0.;
      for (unsigned int n = 1; n <= shape.a.size(); ++n)
      {
        const double sine = std::sin(pi * n * x);
        sum += shape.power(n) * sine * sine;
      }
      return sum;
    }

    /// S'(x) = sum P_n pi n sin(2 pi n x).
    double
    sine_sum_derivative(const WaveShape &shape, const double x)
    {
      double sum = 0.;
      for (unsigned int n = 1; n <= shape.a.size(); ++n)
        sum += shape.power(n) * pi * n * std::sin(2. * pi * n * x);
      return sum;
    }

    /// g(y) = sum a_n sin q_n y + b_n cos q_n y at equidistant places.
    std::vector<double>
    strain_of_speed_1(const WaveShape &shape)
    {
      const unsigned int points = 128 * static_cast<unsigned int>(shape.a.size());
      std::vector<double> g(points);
      for (unsigned int i = 0; i < points; ++i)
        for (unsigned int n = 1; n <= shape.a.size(); ++n)
          g[i] +=
            shape.a[n - 1] * std::sin(2. * pi * n * i / points) + shape.b[n - 1] * std::cos(2. * pi * n * i / points);
      return g;
    }

    WaveRoot
    describe(const Body &body,
             const WaveShape &shape,
             const std::vector<double> &g,
             const double chi,
             const double end_time,
             const double c)
    {
      const double L = body.length, gamma = body.friction_coefficient, a = body.friction_exponent();
      WaveRoot root{};
      root.speed      = c;
      root.multiplier = a / (L * gamma * c);

      // displacement = chi^2 [ -2 a T Delta_2/c + (L a/(4 pi c^2)) sum sin(2 pi n c T/L) P_n/n ]
      double sum = 0.;
      for (unsigned int n = 1; n <= shape.a.size(); ++n)
        sum += std::sin(2. * pi * n * c * end_time / L) * shape.power(n) / n;
      root.displacement = chi * chi * (-2. * a * end_time * shape.delta_2() / c + L * a / (4. * pi * c * c) * sum);

      // strain = (chi/c) ( g(s + c t) - g(s) )
      const auto points = static_cast<int>(g.size());
      double smallest = 0., largest = 0.;
      const double travelled = std::abs(c) * end_time / L;
      if (travelled >= 1.)
      {
        const auto [low, high] = std::minmax_element(g.begin(), g.end());
        smallest               = *low - *high;
        largest                = *high - *low;
      }
      else
      {
        const auto window = static_cast<int>(travelled * points);
        for (int i = 0; i < points; ++i)
          for (int j = 0; j <= window; ++j)
          {
            const int shifted   = ((c > 0 ? i + j : i - j) + points) % points;
            const double change = g[shifted] - g[i];
            smallest            = std::min(smallest, change);
            largest             = std::max(largest, change);
          }
      }
      const double factor = chi / c;
      root.min_stretch    = 1. + std::min(factor * smallest, factor * largest);
      root.max_stretch    = 1. + std::max(factor * smallest, factor * largest);
      return root;
    }

    /// Adds the roots x of f(x) = h x^2 - S(x) from 0 to @p last in their order, without x = 0; false if @p is_enough
    /// has ended that. At most one root lies between neighbouring critical points of f.
    bool
    add_roots(const WaveShape &shape, const double h, const double last, const auto &is_enough, const auto &add)
    {
      const auto f          = [&](const double x) { return h * x * x - sine_sum(shape, x); };
      const auto derivative = [&](const double x) { return 2. * h * x - sine_sum_derivative(shape, x); };
      const double total    = 4. * shape.delta_2();
      const auto n          = static_cast<double>(shape.a.size());
      const double step     = 1. / (32. * n);
      double previous       = 1e-6 / n;
      const auto look_until = [&](const double next) {
        if (f(previous) == 0.)
          add(previous);
        else if (f(previous) * f(next) < 0.)
          add(bracketed_root(f, previous, next));
        previous = next;
      };
      for (double x = previous; x < last; x += step)
      {
        if (is_enough())
          return false;
        const double right = std::min(x + step, last);
        if (derivative(x) * derivative(right) < 0.)
        {
          const double critical = bracketed_root(derivative, x, right);
          if (std::abs(f(critical)) <= 1e-14 * total)
          {
            add(critical);
            previous = critical + 1e-9 * step;
          }
          else
            look_until(critical);
        }
      }
      look_until(last);
      return true;
    }
  } // namespace

  double
  WaveShape::delta_2() const
  {
    double sum = 0.;
    for (unsigned int n = 1; n <= a.size(); ++n)
      sum += power(n);
    return sum / 4.;
  }

  WaveRoot
  describe_wave(const Body &body, const WaveShape &shape, const double chi, const double end_time, const double c)
  {
    return describe(body, shape, strain_of_speed_1(shape), chi, end_time, c);
  }

  WaveRoots
  find_wave_roots(const Body &body,
                  const WaveShape &shape,
                  const double chi,
                  const double end_time,
                  const double energy,
                  const unsigned int at_least)
  {
    const double L = body.length, gamma = body.friction_coefficient, k = body.elastic_modulus;
    const double sign      = body.friction_exponent() > 0 ? -1. : 1.; // the direction that moves the body to +s
    const auto n_harmonics = static_cast<unsigned int>(shape.a.size());

    WaveRoots result{};
    result.smallest_energy = 2. * L * gamma * end_time * shape.delta_2();
    double slope           = 0.; // lim S(x)/x^2 for x -> 0
    unsigned int common    = 0;  // greatest common divisor of the harmonics present
    for (unsigned int n = 1; n <= n_harmonics; ++n)
      if (shape.power(n) > 0.)
      {
        slope += pi * pi * n * n * shape.power(n);
        common = std::gcd(common, n);
      }
    result.largest_energy = result.smallest_energy + k * end_time * end_time / L * slope;
    const double h        = (energy - result.smallest_energy) * L / (k * end_time * end_time);
    result.double_roots   = std::abs(energy - result.smallest_energy) <= 1e-12 * result.smallest_energy;
    result.complete       = true;
    if (common == 0 || (!result.double_roots && (h < 0. || h >= slope)))
      return result;

    const std::vector<double> g = strain_of_speed_1(shape);
    unsigned int admissible     = 0;
    const auto enough           = [&]() {
      return result.roots.size() >= max_roots || (result.roots.size() >= at_least && admissible >= 10);
    };
    const auto add = [&](const double x) {
      result.roots.push_back(describe(body, shape, g, chi, end_time, sign * x * L / end_time));
      admissible += result.roots.back().admissible();
    };

    if (result.double_roots)
    {
      result.complete = false;
      for (unsigned int j = 1; !enough(); ++j)
        add(static_cast<double>(j) / common);
      return result;
    }

    const double last   = std::sqrt(4. * shape.delta_2() / h) * (1. + 1e-12); // S <= 4 delta_2
    const bool list_all = 2. * n_harmonics * last <= few_roots;
    result.complete     = add_roots(
      shape, h, last, [&]() { return !list_all && enough(); }, add);
    return result;
  }
} // namespace crawler
