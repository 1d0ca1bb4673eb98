// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/scene.h>

namespace crawler
{
  /**
   * Sets the efficiencies of the whole run and of its last stride alone in the result of a run that finished: the part
   * of the largest displacement that any gait with these extreme stretches and this work can reach, at most 1:
   * D/(F sqrt(W T/L)), F = 1/sqrt(g_min) - 1/sqrt(g_max) with the smallest and the largest friction per velocity
   * between these stretches (doc/theory.md, "Gait efficiency"). W is energy_of_bound(); that of a stride is its
   * dissipation, since a gait that repeats gives back the elastic energy that its start took. Nothing if no such bound
   * exists, since the friction depends on the place or the direction, or if it is not defined: no work, no strain or no
   * resistance that depends on it.
   */
  void
  set_efficiencies(const Scene &scene, SimulationResult &result);

  /// Energy in the bound [energy]: the work of the active stress if the body starts unstretched, else the dissipation,
  /// which that work may not exceed.
  double
  energy_of_bound(const EnergyBalance &balance);

  /// True if the body starts unstretched.
  bool
  starts_from_rest(const EnergyBalance &balance);
} // namespace crawler
