// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

namespace crawler
{
  struct Scene;

  /// Converts natural units to those of the user's @p scene. A finished run has the time of the scene's end, and with
  /// an energy balance its gait efficiency.
  SimulationResult
  in_user_units(SimulationResult result, const Scene &scene, const Units &units);
} // namespace crawler
