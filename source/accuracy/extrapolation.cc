// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/extrapolation.h>
#include <crawler/run/gait_efficiency.h>

#include <algorithm>

namespace crawler
{
  std::vector<double>
  weights_at_zero(const std::span<const double> x)
  {
    std::vector<double> weights(x.size(), 1.);
    for (std::size_t k = 0; k < x.size(); ++k)
      for (std::size_t j = 0; j < x.size(); ++j)
        if (j != k)
          weights[k] *= x[j] / (x[j] - x[k]);
    return weights;
  }

  SimulationResult
  combined(const Scene &scene,
           const std::span<const SimulationResult *const> results,
           const std::span<const double> weights)
  {
    SimulationResult sum    = *results.back();
    const std::size_t last  = results.size() - 1;
    const auto all          = [&](const auto &has) { return std::ranges::all_of(results, has); };
    const bool have_balance = all([](const auto *r) { return r->energy_balance.has_value(); });
    const bool have_gait =
      sum.gait && all([&](const auto *r) { return r->gait && r->gait->period == sum.gait->period; });
    const bool have_gait_balance = have_gait && all([](const auto *r) { return r->gait->energy_balance.has_value(); });
    sum.displacement *= weights[last];
    if (have_balance)
      sum.energy_balance = sum.energy_balance->scaled(weights[last]);
    if (have_gait)
      sum.gait->displacement *= weights[last];
    if (have_gait_balance)
      sum.gait->energy_balance = sum.gait->energy_balance->scaled(weights[last]);
    for (std::size_t k = 0; k < last; ++k)
    {
      sum.displacement += weights[k] * results[k]->displacement;
      if (have_balance)
        sum.energy_balance = sum.energy_balance->combined(1., *results[k]->energy_balance, weights[k]);
      if (have_gait)
        sum.gait->displacement += weights[k] * results[k]->gait->displacement;
      if (have_gait_balance)
        sum.gait->energy_balance =
          sum.gait->energy_balance->combined(1., *results[k]->gait->energy_balance, weights[k]);
    }
    set_efficiencies(scene, sum);
    return sum;
  }
} // namespace crawler
