// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/reduced_models/perturbation.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace crawler
{
  namespace
  {
    double
    power(const NaturalWave::Harmonic &h)
    {
      return h.a * h.a + h.b * h.b;
    }
  } // namespace

  double
  perturbation::displacement(const NaturalWave &wave, const double t)
  {
    double sum = 0.;
    for (const auto &h : wave.harmonics)
      sum += power(h) * (-0.5 * wave.speed * t + 0.5 * std::sin(h.q * wave.speed * t) / h.q);
    return wave.friction_exponent * sum;
  }

  double
  perturbation::velocity(const NaturalWave &wave, const double t)
  {
    double sum = 0.;
    for (const auto &h : wave.harmonics)
      sum += power(h) * (std::cos(h.q * wave.speed * t) - 1.);
    return 0.5 * wave.friction_exponent * wave.speed * sum + 0.; // never -0
  }

  EnergyBalance
  perturbation::energies(const NaturalWave &wave, const double t)
  {
    EnergyBalance energies;
    energies.positive_work = std::numeric_limits<double>::quiet_NaN();
    for (const auto &h : wave.harmonics)
    {
      const double half = std::sin(0.5 * h.q * wave.speed * t);
      energies.dissipation += 0.5 * wave.speed * wave.speed * power(h) * t;
      energies.elastic_energy += wave.stiffness * power(h) * half * half;
    }
    energies.stress_work    = energies.dissipation + energies.elastic_energy;
    energies.exchanged_work = energies.stress_work; // lower bound
    return energies;
  }

  ReducedFields
  perturbation::fields(const NaturalWave &wave, const double t, const std::vector<double> &points)
  {
    const double c = wave.speed, D = displacement(wave, t), V = velocity(wave, t);
    ReducedFields fields;
    fields.strain.resize(points.size());
    leading_order_strain(wave).at(points)->values(t, fields.strain);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double s = points[i];
      double u = 0., v = 0., m = 0.;
      for (const auto &h : wave.harmonics)
      {
        const double theta = h.q * (s + c * t), start = h.q * s, head = h.q * c * t;
        u += (h.a * (std::cos(start) - std::cos(theta)) + h.b * (std::sin(theta) - std::sin(start))) / h.q;
        v += c * (h.a * std::sin(theta) + h.b * std::cos(theta));
        m += c * (h.a * (std::cos(head) - std::cos(theta)) + h.b * (std::sin(theta) - std::sin(head))) / h.q;
      }
      fields.displacement.push_back(D + u);
      fields.velocity.push_back(V + v);
      fields.active_stress.push_back(m - wave.stiffness * fields.strain[i]);
    }
    return fields;
  }

  StrainExtremes
  perturbation::extremes(const NaturalWave &wave)
  {
    constexpr unsigned int per_wave = 16, most = 2001;
    const double waves = wave.n_waves(), strides = std::abs(wave.speed);
    const auto n_of = [](const double n) {
      return static_cast<unsigned int>(std::min<double>(most, per_wave * std::ceil(n) + 1));
    };
    return find_extremes(leading_order_strain(wave), 1., 1., n_of(waves), n_of(waves * std::max(1., strides)));
  }
} // namespace crawler
