// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/scene.h>

#include <optional>

namespace crawler
{
  /**
   * The part of the largest displacement that any gait with these extreme stretches and this work can reach, at most 1:
   * D/(F sqrt(W T/(gamma L))), F = |w_min^(-a/2) - w_max^(-a/2)| (doc/theory.md, "Gait efficiency"). For the
   * p-model of friction and a run from rest. Nothing if it is not defined: no work, no strain or no resistance
   * that depends on it.
   */
  std::optional<double>
  gait_efficiency(const Scene &scene, const SimulationResult &result);
} // namespace crawler
