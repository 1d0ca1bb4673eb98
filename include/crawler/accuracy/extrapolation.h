// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/scene.h>

#include <span>
#include <vector>

namespace crawler
{
  /// Extrapolated result: the last of the @p results, with the sum of @p weights times all of them for displacement and
  /// works, those of the last stride too, and the numbers that follow from them.
  SimulationResult
  combined(const Scene &scene, std::span<const SimulationResult *const> results, std::span<const double> weights);
} // namespace crawler
