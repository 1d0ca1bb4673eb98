// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "../support/run_text.h"
#include "setting_search.h"

#include <crawler/run/batch.h>

namespace crawler::test
{
  using BatchResults = std::vector<std::optional<SimulationResult>>;

  /// @p n scenes whose perturbation parameters lie from that of @p parameters, which is the first, to 1e-6 above it.
  std::vector<Scene>
  similar_scenes(Parameters parameters, std::size_t n);

  /// A grid over friction exponents in [-3, -0.5] and perturbation parameters in [0.05, 0.45], k = c = T = 1.
  std::vector<Scene>
  grid_of_scenes(std::size_t n_exponents, std::size_t n_chi);

  /// What a batch makes of scenes with one setting.
  BatchResults
  run_scenes(std::span<const Scene> scenes,
             const Setting &setting,
             const RecordOptions &options = {},
             const LaneEngine &engine     = batch_engine());
} // namespace crawler::test
