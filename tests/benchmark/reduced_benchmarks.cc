// SPDX-License-Identifier: LGPL-2.1-or-later
#include "benchmarks.h"

#include "../support/run_text.h"

#include <crawler/accuracy/model_choice.h>
#include <crawler/run/reduced_model.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <memory>

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

    /// A body at a = 0. The displacement is 0, so errors are those of the work of its actuators.
    struct BodyAtAZero
    {
      explicit BodyAtAZero(const bool linear)
        : parameters(parameters_with({{"Body/Anchoring exponent", "1"},
                                      {"Active stress/Generator", "expression"},
                                      {"Active stress/Expression/Active stress", "0.3*sin(2*pi*(s+t))*exp(s)"}}))
        , scene(parameters.create_scene())
        , numerics({.degree = 8, .n_cells = 6, .linear = linear, .integrator = "radau 9"})
      {
      }

      double
      work(const double tolerance)
      {
        numerics.tolerance    = tolerance;
        numerics.initial_step = 0.01;
        return Simulation(MPI_COMM_WORLD, scene, parameters.time, numerics)
          .run({}, {.energy_balance = true})
          .energy_balance->stress_work;
      }

      const Parameters parameters;
      const Scene scene;
      Numerics numerics;
    };

    void
    run_reduced_model(benchmark::State &state, const bool linear, const double tolerance)
    {
      static const double exact = BodyAtAZero(false).work(1e-13);
      BodyAtAZero body(linear);
      const double error = std::abs(body.work(tolerance) / exact - 1.);
      Simulation simulation(MPI_COMM_WORLD, body.scene, body.parameters.time, body.numerics);
      unsigned int steps = 0;
      for (auto _ : state)
        steps = simulation.run({}, {}).time.steps;
      state.SetItemsProcessed(state.iterations());
      state.counters["error"] = error;
      state.counters["steps"] = steps;
    }
  } // namespace

  void
  add_reduced_benchmarks()
  {
    const Settings small    = wave(-1., 0.05);
    const Settings fraction = wave(-1.3, 0.05);
    const Settings strain   = {{"Active stress/Generator", "prescribed strain"},
                               {"Active stress/Prescribed strain/Given by", "wave"}};
    benchmark::RegisterBenchmark("level/perturbation", level, small, "perturbation", 1e-2);
    benchmark::RegisterBenchmark("level/perturbation/a=-1.3", level, fraction, "perturbation", 1e-2);
    benchmark::RegisterBenchmark("level/estimate", estimate, small);
    benchmark::RegisterBenchmark("level/estimate/a=-1.3", estimate, fraction);
    benchmark::RegisterBenchmark("level/kinematic", level, strain, "kinematic", 1e-6);
    benchmark::RegisterBenchmark("level/kinematic/1e-10", level, strain, "kinematic", 1e-10);
    for (const bool linear : {true, false})
      for (const double tolerance : {1e-4, 1e-6, 1e-8})
        benchmark::RegisterBenchmark(fmt::format("level/{}/{:.0e}", linear ? "linear" : "nonlinear", tolerance).c_str(),
                                     run_reduced_model,
                                     linear,
                                     tolerance);
  }
} // namespace crawler::test
