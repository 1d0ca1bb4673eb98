// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What objects cost before they compute (Google Benchmark), for the mesh of run/petsc/1e-6:
//
//   run/setup/bdf ...          run() of a Simulation that has run before, stopped at its first state: all of the set-up
//                              but that within PETSc's TSSolve
//   run/one_step/bdf ...       the same, stopped after its first step
//   run/two_steps/bdf ...      and after its second: 2 one_step - two_steps is about the set-up of a second run
//   run/construction/bdf ...   a new Simulation for another scene, its first run included up to its first state
#include "../support/run_text.h"

#include <crawler/base/mpi_session.h>

#include <benchmark/benchmark.h>

using namespace crawler;

namespace
{
  const Numerics mesh{7, 5, 1e-6, 1e-5};

  Parameters
  parameters(const std::string &integrator, const double chi = 0.4)
  {
    auto result            = test::parameters_with(test::wave(-1., chi));
    result.time.integrator = integrator;
    return result;
  }

  /// Runs up to the step with this number; 0 is the first state.
  void
  run_to(Simulation &simulation, const unsigned int last_step)
  {
    unsigned int number = 0;
    simulation.run({}, {}, {}, [&]() { return number++ < last_step; });
  }

  void
  second_run(benchmark::State &state, const std::string &integrator, const unsigned int last_step)
  {
    const auto chosen = parameters(integrator);
    const Scene scene = chosen.create_scene();
    Simulation simulation(MPI_COMM_WORLD, scene, chosen.time, mesh);
    simulation.run({}, {});
    for (auto _ : state)
      run_to(simulation, last_step);
    state.SetItemsProcessed(state.iterations());
  }

  void
  construction(benchmark::State &state, const std::string &integrator)
  {
    const auto chosen    = parameters(integrator);
    const Scene scenes[] = {chosen.create_scene(), parameters(integrator, 0.3).create_scene()};
    unsigned int i       = 0;
    for (auto _ : state)
    {
      Simulation simulation(MPI_COMM_WORLD, scenes[++i % 2], chosen.time, mesh);
      run_to(simulation, 0);
    }
    state.SetItemsProcessed(state.iterations());
  }
} // namespace

int
main(int argc, char **argv)
{
  int one = 1;
  const crawler::MpiSession guard(one, argv);
  for (const std::string integrator : {"bdf", "radau 5"})
  {
    const auto add = [&](const std::string &name, const auto &function, const auto &...arguments) {
      benchmark::RegisterBenchmark((name + integrator).c_str(), function, integrator, arguments...)
        ->Unit(benchmark::kMicrosecond);
    };
    add("run/setup/", second_run, 0u);
    add("run/one_step/", second_run, 1u);
    add("run/two_steps/", second_run, 2u);
    add("run/construction/", construction);
  }
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
