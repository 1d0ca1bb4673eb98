// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Rungs against each other on scenes that both can compute.
#include "../support/run_text.h"
#include "benchmarks.h"

#include <benchmark/benchmark.h>

#include <cmath>

namespace crawler::test
{
  namespace
  {
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
          .run({}, {.ledger = true})
          .ledger->stress_power;
      }

      const Parameters parameters;
      const Scene scene;
      Numerics numerics;
    };

    void
    run_rung(benchmark::State &state, const bool linear, const double tolerance)
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
  add_rung_benchmarks()
  {
    for (const bool linear : {true, false})
      for (const auto &[name, tolerance] : {std::pair("1e-4", 1e-4), std::pair("1e-6", 1e-6), std::pair("1e-8", 1e-8)})
        benchmark::RegisterBenchmark(
          (std::string("rung/") + (linear ? "linear/" : "nonlinear/") + name).c_str(), run_rung, linear, wanted);
  }
} // namespace crawler::test
