// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/strain.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crawler
{
  unsigned int
  NaturalWave::n_waves() const
  {
    double q = 0.;
    for (const Harmonic &harmonic : harmonics)
      q = std::max(q, harmonic.q);
    return static_cast<unsigned int>(std::lround(q / (2. * std::numbers::pi)));
  }

  NaturalWave
  natural_wave(const Scene &scene, const OptimalWave &wave)
  {
    const double c = wave.wave().speed, chi = wave.perturbation_parameter();
    const WaveShape &shape = wave.shape();
    NaturalWave result{c * scene.end_time / scene.body.length,
                       scene.body.friction_exponent(),
                       scene.body.elastic_modulus / natural_units(scene).force,
                       {}};
    for (unsigned int n = 1; n <= shape.a.size(); ++n)
      if (shape.power(n) != 0.)
        result.harmonics.push_back({2. * std::numbers::pi * n, chi * (shape.a[n - 1] / c), chi * (shape.b[n - 1] / c)});
    return result;
  }

  StressByFunctions
  leading_order_strain(const NaturalWave &wave)
  {
    using Harmonic = NaturalWave::Harmonic;
    ActiveStress::Bounds bounds{0., 0.};
    for (const Harmonic &h : wave.harmonics)
    {
      const double amplitude = std::hypot(h.a, h.b);
      bounds.value += 2. * amplitude;
      bounds.rate += h.q * std::abs(wave.speed) * amplitude;
    }
    const auto evaluator = [wave](const std::vector<double> &points, const bool rate) {
      std::vector<double> sine, cosine; // [harmonic][point]
      for (const Harmonic &h : wave.harmonics)
        for (const double s : points)
        {
          sine.push_back(std::sin(h.q * s));
          cosine.push_back(std::cos(h.q * s));
        }
      // Sum of sin qs and cos qs, with factors that are functions of the harmonic and of theta = q c t.
      const auto combine = [&](const auto &factors) {
        return stress_at_points([wave, sine, cosine, factors](const double t, const std::span<double> result) {
          std::fill(result.begin(), result.end(), 0.);
          for (std::size_t n = 0; n < wave.harmonics.size(); ++n)
          {
            const Harmonic &h               = wave.harmonics[n];
            const auto [of_sine, of_cosine] = factors(h, h.q * wave.speed * t);
            const std::size_t first         = n * result.size();
            for (std::size_t i = 0; i < result.size(); ++i)
              result[i] += of_sine * sine[first + i] + of_cosine * cosine[first + i];
          }
        });
      };
      if (rate)
        return combine([c = wave.speed](const Harmonic &h, const double theta) {
          const double qc = h.q * c, st = std::sin(theta), ct = std::cos(theta);
          return std::pair(-qc * (h.a * st + h.b * ct), qc * (h.a * ct - h.b * st));
        });
      return combine([](const Harmonic &h, const double theta) {
        const double half = std::sin(0.5 * theta), st = std::sin(theta), ct_minus_1 = -2. * half * half;
        return std::pair(h.a * ct_minus_1 - h.b * st, h.a * st + h.b * ct_minus_1);
      });
    };
    return StressByFunctions(evaluator, [bounds](const ActiveStress::Box &) { return bounds; });
  }
} // namespace crawler
