// SPDX-License-Identifier: LGPL-2.1-or-later
#include "batch_scenes.h"

namespace crawler::test
{
  BatchScenes
  BatchScenes::similar(Parameters parameters, const std::size_t n)
  {
    BatchScenes result;
    double &chi        = parameters.active_stress.optimal_wave.perturbation_parameter;
    const double first = chi;
    for (std::size_t i = 0; i < n; ++i)
    {
      chi = first + 1e-6 * static_cast<double>(i) / static_cast<double>(n);
      result.scenes_.push_back(parameters.create_scene());
    }
    return result;
  }

  BatchScenes
  BatchScenes::grid(const std::size_t n_exponents, const std::size_t n_chi)
  {
    const auto part = [](const std::size_t i, const std::size_t n) {
      return static_cast<double>(i) / static_cast<double>(n - 1);
    };
    BatchScenes result;
    Parameters parameters = parameters_with(wave(-1., 0.4));
    for (std::size_t i = 0; i < n_exponents; ++i)
      for (std::size_t j = 0; j < n_chi; ++j)
      {
        parameters.body.anchoring_exponent                           = 1. - (-3. + 2.5 * part(i, n_exponents));
        parameters.active_stress.optimal_wave.perturbation_parameter = 0.05 + 0.4 * part(j, n_chi);
        result.scenes_.push_back(parameters.create_scene());
      }
    return result;
  }

  BatchScenes::Results
  BatchScenes::run(const Setting &setting,
                   const std::size_t begin,
                   const std::size_t end,
                   const Simulation::Options &options,
                   const LaneEngine &engine) const
  {
    std::vector<BatchRun> runs;
    runs.reserve(end - begin);
    for (std::size_t i = begin; i < end; ++i)
      runs.push_back({&scenes_[i], &setting.time, &setting.numerics});
    return run_batch(runs, options, {}, engine);
  }

  BatchScenes::Results
  BatchScenes::run_some(const Setting &setting, const std::vector<std::size_t> &members) const
  {
    std::vector<BatchRun> runs;
    for (const std::size_t i : members)
      runs.push_back({&scenes_[i], &setting.time, &setting.numerics});
    return run_batch(runs, {});
  }
} // namespace crawler::test
