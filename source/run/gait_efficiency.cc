// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/gait_efficiency.h>

#include <cmath>

namespace crawler
{
  std::optional<double>
  gait_efficiency(const Scene &scene, const SimulationResult &result)
  {
    if (!result.energy_balance || !scene.is_plain()) // the bound is for plain bodies and grounds
      return std::nullopt;
    const double min_stretch = result.min_stretch.value, max_stretch = result.max_stretch.value;
    const double work = result.energy_balance->stress_work, a = scene.body.friction_exponent();
    const double F     = std::abs(std::pow(min_stretch, -a / 2.) - std::pow(max_stretch, -a / 2.));
    const double bound = F * std::sqrt(work * scene.end_time / (scene.body.friction_coefficient * scene.body.length));
    return min_stretch > 0. && bound > 0. && std::isfinite(bound) ? std::optional(std::abs(result.displacement) / bound)
                                                                  : std::nullopt;
  }
} // namespace crawler
