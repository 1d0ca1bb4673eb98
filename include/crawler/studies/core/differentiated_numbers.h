// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/works.h>
#include <crawler/run/simulation_result.h>

#include <array>

namespace crawler
{
  /// Number that is differentiated, by its key in the result table.
  struct DifferentiatedNumber
  {
    const char *key;
    double (*of)(const SimulationResult &);
  };

  /// Numbers in the order of all_quantities; the displacement is the first.
  inline constexpr std::array<DifferentiatedNumber, all_quantities.size()> differentiated_numbers = {{
    {"displacement", [](const SimulationResult &result) { return result.displacement; }},
    {"stress_power", [](const SimulationResult &result) { return result.energy_balance->stress_work; }},
    {"dissipation", [](const SimulationResult &result) { return result.energy_balance->dissipation; }},
    {"positive_power", [](const SimulationResult &result) { return result.energy_balance->positive_work; }},
    {"paper_energy", [](const SimulationResult &result) { return result.energy_balance->paper_energy(); }},
    {"gait.displacement", [](const SimulationResult &result) { return result.gait->displacement; }},
    {"gait.speed", [](const SimulationResult &result) { return result.gait->speed(); }},
  }};

  /// Returns true if these results have the number: an energy balance, a last stride.
  inline bool
  has_number(const std::size_t number, const SimulationResult &result)
  {
    return is_work(all_quantities[number]) ? result.energy_balance.has_value() : number == 0 || result.gait.has_value();
  }
} // namespace crawler
