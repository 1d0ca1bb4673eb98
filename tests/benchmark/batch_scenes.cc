// SPDX-License-Identifier: LGPL-2.1-or-later
#include "batch_scenes.h"

namespace crawler::test
{
  std::vector<Scene>
  similar_scenes(Parameters parameters, const std::size_t n)
  {
    std::vector<Scene> scenes;
    double &chi        = parameters.active_stress.optimal_wave.perturbation_parameter;
    const double first = chi;
    for (std::size_t i = 0; i < n; ++i)
    {
      chi = first + 1e-6 * static_cast<double>(i) / static_cast<double>(n);
      scenes.push_back(parameters.create_scene());
    }
    return scenes;
  }

  std::vector<Scene>
  grid_of_scenes(const std::size_t n_exponents, const std::size_t n_chi)
  {
    const auto part = [](const std::size_t i, const std::size_t n) {
      return static_cast<double>(i) / static_cast<double>(n - 1);
    };
    std::vector<Scene> scenes;
    Parameters parameters = parameters_with(wave(-1., 0.4));
    for (std::size_t i = 0; i < n_exponents; ++i)
      for (std::size_t j = 0; j < n_chi; ++j)
      {
        parameters.body.anchoring_exponent                           = 1. - (-3. + 2.5 * part(i, n_exponents));
        parameters.active_stress.optimal_wave.perturbation_parameter = 0.05 + 0.4 * part(j, n_chi);
        scenes.push_back(parameters.create_scene());
      }
    return scenes;
  }

  BatchResults
  run_scenes(const std::span<const Scene> scenes,
             const Setting &setting,
             const RecordOptions &options,
             const LaneEngine &engine)
  {
    std::vector<BatchRun> runs;
    runs.reserve(scenes.size());
    for (const Scene &scene : scenes)
      runs.push_back({&scene, &setting.time, &setting.numerics});
    return run_batch(runs, options, {}, engine);
  }
} // namespace crawler::test
