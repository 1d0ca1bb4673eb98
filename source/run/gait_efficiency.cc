// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/gait_efficiency.h>

#include <cmath>
#include <limits>

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
      const double from = result.min_stretch.value, to = result.max_stretch.value;
      if (scene.profiles.friction || !scene.ground.is_plain() || !(from > 0.))
        return std::nullopt;
      const double bound = largest_merit(*scene.friction, from, to) * std::sqrt(energy * duration / scene.body.length);
      return bound > 0. && std::isfinite(bound) ? std::optional(std::abs(displacement) / bound) : std::nullopt;
    }
  } // namespace

  std::optional<double>
  gait_efficiency(const Scene &scene, const SimulationResult &result)
  {
    if (!result.energy_balance)
      return std::nullopt;
    return part_of_bound(scene, result, result.displacement, energy_of_bound(*result.energy_balance), scene.end_time);
  }

  std::optional<double>
  stride_efficiency(const Scene &scene, const SimulationResult &result)
  {
    if (!result.gait || !result.gait->energy_balance)
      return std::nullopt;
    const Gait &gait = *result.gait;
    return part_of_bound(scene, result, gait.displacement, gait.energy_balance->dissipation, gait.period);
  }

  double
  error_of_efficiencies(const Scene &scene, const SimulationResult &result)
  {
    const Extreme &low = result.min_stretch, &high = result.max_stretch;
    const double from = low.value + low.jump, to = high.value - high.jump;
    return from < to
             ? largest_merit(*scene.friction, low.value, high.value) / largest_merit(*scene.friction, from, to) - 1.
             : std::numeric_limits<double>::infinity();
  }

  void
  set_efficiencies(const Scene &scene, SimulationResult &result)
  {
    if (result.time.status != Status::finished)
      return;
    result.gait_efficiency = gait_efficiency(scene, result);
    if (result.gait)
      result.gait->efficiency = stride_efficiency(scene, result);
  }
} // namespace crawler
