// SPDX-License-Identifier: LGPL-2.1-or-later
#include "benchmarks.h"

#include "../support/run_text.h"

#include <crawler/accuracy/model_choice.h>
#include <crawler/run/reduced_model.h>

#include <benchmark/benchmark.h>


namespace crawler::test
{
  namespace
  {
    /// Whole runs on a level, from the scene to the result with its error, the energy balance and the extremes.
    void
    level(benchmark::State &state, const Settings &settings, const std::string &model, const double accuracy)
    {
      const Parameters parameters = parameters_with(settings);
      const Scene scene           = parameters.create_scene();
      SimulationResult result;
      for (auto ignored : state)
      {
        result = ReducedModel(scene, from_word<Model>(model).value()).compute(accuracy, true);
        benchmark::DoNotOptimize(result.displacement);
      }
      state.SetItemsProcessed(state.iterations());
      state.SetLabel(word_of(result.time.status));
    }

    /// The estimate of the models' errors alone.
    void
    estimate(benchmark::State &state, const Settings &settings)
    {
      const Scene scene = parameters_with(settings).create_scene();
      const ReducedScene levels(scene);
      for (auto ignored : state)
      {
        const ModelErrors errors = levels.model_errors();
        benchmark::DoNotOptimize(errors.perturbation);
      }
      state.SetItemsProcessed(state.iterations());
    }
  } // namespace

  void
  add_reduced_benchmarks()
  {
    const Settings small    = wave(-1., 0.05);
    const Settings fraction = wave(-1.3, 0.05);
    const Settings strain   = set("prescribed strain; Given by = wave");
    benchmark::RegisterBenchmark("level/perturbation", level, small, "perturbation", 1e-2);
    benchmark::RegisterBenchmark("level/perturbation/a=-1.3", level, fraction, "perturbation", 1e-2);
    benchmark::RegisterBenchmark("level/estimate", estimate, small);
    benchmark::RegisterBenchmark("level/estimate/a=-1.3", estimate, fraction);
    benchmark::RegisterBenchmark("level/kinematic", level, strain, "kinematic", 1e-6);
    benchmark::RegisterBenchmark("level/kinematic/1e-10", level, strain, "kinematic", 1e-10);
  }
} // namespace crawler::test
