// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/gait_efficiency.h>

#include <cmath>
#include <optional>

namespace crawler
{
  bool
  starts_from_rest(const EnergyBalance &balance)
  {
    constexpr double round_off = 1e-12;
    return balance.initial_energy <= round_off * balance.exchanged_work;
  }

  double
  energy_of_bound(const EnergyBalance &balance)
  {
    return starts_from_rest(balance) ? balance.stress_work : balance.dissipation;
  }

  namespace
  {
    /// Ratio of a displacement to the largest one with this energy in this time.
    std::optional<double>
    part_of_bound(const Scene &scene,
                  const SimulationResult &result,
                  const double displacement,
                  const double energy,
                  const double duration)
    {
      const double from = result.stretch.min.value, to = result.stretch.max.value;
      if (scene.profiles.friction || !scene.ground.is_plain() || !(from > 0.))
        return std::nullopt;
      const double bound = largest_merit(*scene.friction, from, to) * std::sqrt(energy * duration / scene.body.length);
      return bound > 0. && std::isfinite(bound) ? std::optional(std::abs(displacement) / bound) : std::nullopt;
    }
  } // namespace

  void
  set_efficiencies(const Scene &scene, SimulationResult &result)
  {
    if (result.time.status != Status::finished)
      return;
    if (const auto &balance = result.energy_balance)
      result.gait_efficiency =
        part_of_bound(scene, result, result.displacement, energy_of_bound(*balance), scene.end_time);
    if (result.gait && result.gait->energy_balance)
      result.gait->efficiency = part_of_bound(
        scene, result, result.gait->displacement, result.gait->energy_balance->dissipation, result.gait->period);
  }
} // namespace crawler
