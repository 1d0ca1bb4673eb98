// SPDX-License-Identifier: LGPL-2.1-or-later
#include "benchmarks.h"

#include "../support/run_text.h"

#include <crawler/drivers/model_choice.h>
#include <crawler/drivers/rung.h>

#include <benchmark/benchmark.h>

#include <memory>

namespace crawler::test
{
  namespace
  {
    /// Whole runs on a rung, from the scene to the result with its error, the ledger and the extremes.
    void
    rung(benchmark::State &state, const Settings &settings, const std::string &model, const double accuracy)
    {
      const Parameters parameters = parameters_with(settings);
      const Scene scene           = parameters.create_scene();
      SimulationResult result;
      for (auto ignored : state)
      {
        result = Rung(scene, model).compute(accuracy, true);
        benchmark::DoNotOptimize(result.displacement);
      }
      state.SetItemsProcessed(state.iterations());
      state.SetLabel(result.time.status);
    }

    /// The estimate of the models' errors alone.
    void
    estimate(benchmark::State &state, const Settings &settings)
    {
      const Scene scene = parameters_with(settings).create_scene();
      const RungScene rungs(scene);
      for (auto ignored : state)
      {
        const ModelErrors errors = rungs.model_errors();
        benchmark::DoNotOptimize(errors.perturbation);
      }
      state.SetItemsProcessed(state.iterations());
    }
  } // namespace

  void
  add_rung_benchmarks()
  {
    const Settings small    = wave(-1., 0.05);
    const Settings fraction = wave(-1.3, 0.05);
    const Settings strain   = {{"Active stress/Generator", "prescribed strain"},
                               {"Active stress/Prescribed strain/Given by", "wave"}};
    benchmark::RegisterBenchmark("rung/perturbation", rung, small, "perturbation", 1e-2);
    benchmark::RegisterBenchmark("rung/perturbation/a=-1.3", rung, fraction, "perturbation", 1e-2);
    benchmark::RegisterBenchmark("rung/estimate", estimate, small);
    benchmark::RegisterBenchmark("rung/estimate/a=-1.3", estimate, fraction);
    benchmark::RegisterBenchmark("rung/kinematic", rung, strain, "kinematic", 1e-6);
    benchmark::RegisterBenchmark("rung/kinematic/1e-10", rung, strain, "kinematic", 1e-10);
  }
} // namespace crawler::test
