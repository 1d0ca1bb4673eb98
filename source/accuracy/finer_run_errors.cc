// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/finer_run_errors.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    // Calibrated by tests/verification/number_errors.py.
    constexpr double more_if_sampled = 1.5, sampling_error = 2.;

    struct Number
    {
      double value = std::numeric_limits<double>::quiet_NaN(), scale = 0.;
      bool is_sampled = false;
    };
    using Numbers = std::array<Number, NumberErrors::n>;

    Number
    with_own_scale(const std::optional<double> value)
    {
      return value ? Number{*value, std::abs(*value)} : Number();
    }

    /// In the order of the keys.
    Numbers
    numbers_of(const SimulationResult &result)
    {
      Numbers numbers;
      auto next         = numbers.begin();
      const auto energy = [&](auto value, const bool is_sampled = false) {
        *next++ = result.energy_balance
                    ? Number{value(*result.energy_balance), result.energy_balance->exchanged, is_sampled}
                    : Number();
      };
      const auto cost = [&](auto value, const bool is_sampled = false) {
        *next++ = Number();
        if (!result.gait || !result.gait->energy_balance)
          return;
        const Gait &gait = *result.gait;
        if (const auto per_distance = gait.cost_of_transport(value(*gait.energy_balance)))
          *(next - 1) = {*per_distance, gait.energy_balance->exchanged / std::abs(gait.displacement), is_sampled};
      };
      const auto stress_power   = [](const EnergyBalance &l) { return l.stress_power; };
      const auto dissipation    = [](const EnergyBalance &l) { return l.dissipation; };
      const auto paper_energy   = [](const EnergyBalance &l) { return l.paper_energy(); };
      const auto positive_power = [](const EnergyBalance &l) { return l.positive_power; };
      energy(stress_power);
      energy(dissipation);
      energy([](const EnergyBalance &l) { return l.elastic_energy; });
      energy(paper_energy);
      energy(positive_power, true);
      const double strain = std::max(1. - result.min_stretch.value, result.max_stretch.value - 1.);
      *next++             = {result.min_stretch.value, strain, true};
      *next++             = {result.max_stretch.value, strain, true};
      const auto of_gait  = [&](auto value) { *next++ = result.gait ? with_own_scale(value(*result.gait)) : Number(); };
      of_gait([](const Gait &g) { return std::optional(g.displacement); });
      of_gait([](const Gait &g) { return std::optional(g.speed()); });
      cost(stress_power);
      cost(positive_power, true);
      cost(paper_energy);
      cost(dissipation);
      of_gait([](const Gait &g) { return g.slip(); });
      of_gait([](const Gait &g) { return g.wave_speed(); });
      *next            = with_own_scale(result.gait_efficiency);
      next->is_sampled = true; // it follows from the extreme stretches
      return numbers;
    }
  } // namespace

  NumberErrors
  number_errors(const SimulationResult &result, const SimulationResult &finer, const double factor, const double part)
  {
    NumberErrors errors;
    const Numbers numbers = numbers_of(result), better = numbers_of(finer);
    const double n_points = result.mesh ? result.mesh->n_cells * (result.mesh->degree + 1.) : 1.;
    for (std::size_t i = 0; i < NumberErrors::n; ++i)
    {
      const auto &[value, scale, is_sampled] = numbers[i];
      const double x                         = std::abs(value - better[i].value);
      errors.values[i]                       = is_sampled
                                                 ? more_if_sampled * factor * x + (part + sampling_error / (n_points * n_points)) * scale
                                                 : factor * x + part * scale;
    }
    return errors;
  }
} // namespace crawler
