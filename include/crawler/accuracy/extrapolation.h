// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/scene.h>

#include <span>
#include <vector>

namespace crawler
{
  /// What the polynomial through values at the places @p x (all different, none 0) is at 0: the sum of the values times
  /// these weights, c_k = prod_(j != k) x_j/(x_j - x_k).
  std::vector<double>
  weights_at_zero(std::span<const double> x);

  /// The last of the @p results, with the sum of @p weights times all of them for what an extrapolation is for:
  /// displacement and works, those of the last stride too, and what follows from them.
  SimulationResult
  combined(const Scene &scene, std::span<const SimulationResult *const> results, std::span<const double> weights);
} // namespace crawler
