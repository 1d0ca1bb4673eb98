// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/extrapolation.h>
#include <crawler/run/gait_efficiency.h>

#include <algorithm>

namespace crawler
{
  SimulationResult
  combined(const Scene &scene,
           const std::span<const SimulationResult *const> results,
           const std::span<const double> weights)
  {
    SimulationResult sum    = *results.back();
    const std::size_t last  = results.size() - 1;
    const auto weighted_sum = [&](const auto &number) {
      double value = weights[last] * number(*results[last]);
      for (std::size_t k = 0; k < last; ++k)
        value += weights[k] * number(*results[k]);
      return value;
    };
    const auto combine = [&](EnergyBalance &balance, const auto &of) {
      const auto combine_one = [&](double EnergyBalance::*energy) {
        balance.*energy = weighted_sum([&](const SimulationResult &result) { return of(result).*energy; });
      };
      for (const auto energy : EnergyBalance::energies())
        combine_one(energy);
      combine_one(&EnergyBalance::initial_energy);
    };
    const auto all   = [&](const auto &has) { return std::ranges::all_of(results, has); };
    sum.displacement = weighted_sum([](const SimulationResult &result) { return result.displacement; });
    if (all([](const auto *r) { return r->energy_balance.has_value(); }))
      combine(
        *sum.energy_balance, [](const SimulationResult &result) -> const auto & { return *result.energy_balance; });
    if (sum.gait && all([&](const auto *r) { return r->gait && r->gait->period == sum.gait->period; }))
    {
      sum.gait->displacement = weighted_sum([](const SimulationResult &result) { return result.gait->displacement; });
      if (all([](const auto *r) { return r->gait->energy_balance.has_value(); }))
        combine(
          *sum.gait->energy_balance,
          [](const SimulationResult &result) -> const auto & { return *result.gait->energy_balance; });
    }
    set_efficiencies(scene, sum);
    return sum;
  }
} // namespace crawler
