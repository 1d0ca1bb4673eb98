// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "../support/run_text.h"
#include "setting_search.h"

#include <crawler/run/batch.h>

namespace crawler::test
{
  /// Many scenes, and what a batch makes of them with one setting.
  class BatchScenes
  {
  public:
    using Results = std::vector<std::optional<SimulationResult>>;

    /// @p n scenes whose perturbation parameters lie from that of @p parameters, which is the first, to 1e-6 above it.
    static BatchScenes
    similar(Parameters parameters, std::size_t n);

    /// A grid over friction exponents in [-3, -0.5] and perturbation parameters in [0.05, 0.45], k = c = T = 1.
    static BatchScenes
    grid(std::size_t n_exponents, std::size_t n_chi);

    std::size_t
    size() const
    {
      return scenes_.size();
    }
    const Scene &
    operator[](const std::size_t i) const
    {
      return scenes_[i];
    }

    /// The batch of the scenes from @p begin to before @p end.
    Results
    run(const Setting &setting,
        std::size_t begin,
        std::size_t end,
        const Simulation::Options &options = {},
        const LaneEngine &engine           = batch_engine()) const;

    /// The batch of all scenes.
    Results
    run(const Setting &setting,
        const Simulation::Options &options = {},
        const LaneEngine &engine           = batch_engine()) const
    {
      return run(setting, 0, scenes_.size(), options, engine);
    }

    /// The batch of these scenes.
    Results
    run_some(const Setting &setting, const std::vector<std::size_t> &members) const;

  private:
    std::vector<Scene> scenes_;
  };
} // namespace crawler::test
