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
    NaturalWave result{c * scene.end_time / scene.body.length, scene.body.friction_exponent(), stiffness(scene), {}};
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
      std::vector<double> q;
      for (const Harmonic &h : wave.harmonics)
        q.push_back(h.q);
      return waves_at_points(q, points, [wave, rate](const std::size_t i, const double t) {
        const Harmonic &h  = wave.harmonics[i];
        const double theta = h.q * wave.speed * t, qc = h.q * wave.speed, st = std::sin(theta);
        if (rate)
        {
          const double ct = std::cos(theta);
          return std::array<double, 3>{{0., -qc * (h.a * st + h.b * ct), qc * (h.a * ct - h.b * st)}};
        }
        const double half = std::sin(0.5 * theta), ct_minus_1 = -2. * half * half;
        return std::array<double, 3>{{0., h.a * ct_minus_1 - h.b * st, h.a * st + h.b * ct_minus_1}};
      });
    };
    return StressByFunctions(evaluator, [bounds](const ActiveStress::Box &) { return bounds; });
  }
} // namespace crawler
