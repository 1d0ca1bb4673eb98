// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/scene.h>

#include <span>
#include <vector>

namespace crawler
{
  /// Weights c_k = prod_(j != k) x_j/(x_j - x_k) that give the polynomial through values at the places @p x (all
  /// different, none 0) at 0 as the sum of the values times these weights.
  std::vector<double>
  weights_at_zero(std::span<const double> x);

  /// Extrapolated result: the last of the @p results, with the sum of @p weights times all of them for displacement and
  /// works, those of the last stride too, and the numbers that follow from them.
  SimulationResult
  combined(const Scene &scene, std::span<const SimulationResult *const> results, std::span<const double> weights);
} // namespace crawler
