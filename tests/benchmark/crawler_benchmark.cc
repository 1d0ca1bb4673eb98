// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Speeds of whole runs and of their parts (Google Benchmark). items_per_second counts runs, or calls of a kernel.
//
//   run/petsc/1e-4 ...   The Fig. S1 case (a = -1, chi = 0.4, T = 1) solved to that relative error of the displacement,
//   the
//                        process kept and all objects reused, nothing computed but the displacement. The settings are
//                        the cheapest of a small search, and the counter "error" is the true error that they reach.
//   run/rule/1e-4 ...    The same with the settings that Accuracy chooses, and with the ledger.
//   run/pilot/1e-4 ...   What choosing them costs (set-up of all objects included).
//   kernel/...           Residual, Jacobian, elimination and velocity on a mesh of n cells.
//   kernel/expression/... The active stress as a formula: "bulk" evaluates it at the Gauss points of n cells of degree
//   4
//                        (items are points), "construction" prepares it for a mesh.
//   scale/...            One Newton step (residual, Jacobian, elimination, solution) against the number of unknowns.
#include "../support/run_text.h"

#include <crawler/discretization/position_form.h>
#include <crawler/scene/active_stress/expression.h>

#include <deal.II/base/mpi.h>

#include <benchmark/benchmark.h>

#include <cmath>

using namespace crawler;

namespace
{
  constexpr double exact = 9.0072529800e-2; // doc/theory.md, section 5

  test::Settings
  fig_s1(const double accuracy)
  {
    auto settings = test::wave(-1., 0.4);
    settings.emplace_back("Accuracy", test::text(accuracy));
    return settings;
  }

  double
  seconds_of(const std::function<void()> &action)
  {
    const auto start = std::chrono::steady_clock::now();
    action();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  /// The cheapest of the settings that reach the error.
  Numerics
  cheapest(const double wanted)
  {
    const auto parameters = test::parameters_with(fig_s1(wanted));
    const Scene scene     = parameters.create_scene();
    Numerics best;
    double best_seconds = 1e9;
    for (const unsigned int degree : {4u, 5u, 6u, 7u})
      for (const unsigned int n_cells : {3u, 4u, 5u, 6u, 8u, 10u, 14u})
        for (double tolerance = 3e-5; tolerance > 1e-12; tolerance *= 0.56)
        {
          const Numerics numerics{degree, n_cells, tolerance, 1e-5};
          Simulation simulation(MPI_COMM_WORLD, scene, parameters.time, numerics);
          SimulationResult result = simulation.run({}, {});
          if (std::abs(result.displacement / exact - 1.) > wanted)
            continue;
          double seconds = 1e9;
          for (unsigned int i = 0; i < 10; ++i)
            seconds = std::min(seconds,
                               seconds_of(
                                 [&]()
                                 {
                                   simulation.run({}, {});
                                 }));
          if (seconds < best_seconds)
          {
            best_seconds = seconds;
            best         = numerics;
          }
          break; // smaller tolerances cost more
        }
    return best;
  }

  void
  repeat_run(benchmark::State &state,
             const double accuracy,
             const Numerics &numerics,
             const Simulation::Options &options)
  {
    const auto parameters = test::parameters_with(fig_s1(accuracy));
    const Scene scene     = parameters.create_scene();
    Simulation simulation(MPI_COMM_WORLD, scene, parameters.time, numerics);
    SimulationResult result;
    for (auto _ : state)
      result = simulation.run({}, options);
    state.SetItemsProcessed(state.iterations());
    state.counters["error"]  = std::abs(result.displacement / exact - 1.);
    state.counters["steps"]  = result.time.steps;
    state.counters["cells"]  = numerics.n_cells;
    state.counters["degree"] = numerics.degree;
  }

  void
  run_petsc(benchmark::State &state, const double accuracy)
  {
    repeat_run(state, accuracy, cheapest(accuracy), {});
  }

  void
  run_rule(benchmark::State &state, const double accuracy)
  {
    const auto parameters = test::parameters_with(fig_s1(accuracy));
    const Scene scene     = parameters.create_scene();
    repeat_run(state, accuracy, choose_numerics(MPI_COMM_WORLD, parameters, scene)->numerics, {.ledger = true});
  }

  void
  run_pilot(benchmark::State &state, const double accuracy)
  {
    const auto parameters = test::parameters_with(fig_s1(accuracy));
    const Scene scene     = parameters.create_scene();
    for (auto _ : state)
      benchmark::DoNotOptimize(choose_numerics(MPI_COMM_WORLD, parameters, scene)->numerics.n_cells);
    state.SetItemsProcessed(state.iterations());
  }

  /// Everything that a kernel needs.
  struct Bench
  {
    Bench(const unsigned int n_cells, const unsigned int degree)
      : scene(test::parameters_with(fig_s1(1e-6)).create_scene())
      , discretization(MPI_COMM_WORLD, 1., n_cells, degree)
      , assembler(scene, discretization)
      , matrix(discretization)
      , u(discretization.n_owned())
      , v(u)
      , F(u)
    {
      assembler.residual(0.3, u, v, F);
      assembler.jacobian(0.3, u, v, 100., matrix);
      matrix.factorize();
    }
    Scene scene;
    Discretization discretization;
    PositionForm assembler;
    ChainMatrix<double> matrix;
    std::vector<double> u, v, F;
  };

  void
  kernel(benchmark::State &state, const std::function<void(Bench &)> &action)
  {
    Bench bench(static_cast<unsigned int>(state.range(0)), 4);
    for (auto _ : state)
      action(bench);
    state.SetItemsProcessed(state.iterations());
  }

  /// The points where a mesh of @p n_cells cells of degree 4 asks for the active stress.
  std::vector<double>
  stress_points(const std::size_t n_cells)
  {
    std::vector<double> points(5 * n_cells);
    for (std::size_t i = 0; i < points.size(); ++i)
      points[i] = (static_cast<double>(i) + 0.5) / static_cast<double>(points.size());
    return points;
  }

  void
  expression_bulk(benchmark::State &state)
  {
    const auto points    = stress_points(static_cast<std::size_t>(state.range(0)));
    const auto at_points = Expression({.active_stress = "0.1*sin(2*pi*(s+t))"}, 1., 1.).at(points);
    std::vector<double> m(points.size());
    double t = 0.;
    for (auto _ : state)
    {
      at_points->values(t += 1e-3, m);
      benchmark::DoNotOptimize(m.data());
    }
    state.SetItemsProcessed(state.iterations() * state.range(0) * 5);
  }

  void
  expression_construction(benchmark::State &state)
  {
    const auto points = stress_points(static_cast<std::size_t>(state.range(0)));
    const Expression expression({.active_stress = "0.1*sin(2*pi*(s+t))"}, 1., 1.);
    for (auto _ : state)
      benchmark::DoNotOptimize(expression.at(points));
    state.SetItemsProcessed(state.iterations());
  }

  void
  newton_step(benchmark::State &state)
  {
    Bench bench(static_cast<unsigned int>(state.range(0)), 2);
    double t = 0.;
    for (auto _ : state)
    {
      t += 1e-6; // the active stress is evaluated once in a step
      bench.assembler.residual(t, bench.u, bench.v, bench.F);
      bench.assembler.jacobian(t, bench.u, bench.v, 100., bench.matrix);
      bench.matrix.factorize();
      bench.matrix.solve(bench.F, bench.F);
    }
    state.SetItemsProcessed(state.iterations());
    state.counters["ns_per_cell"] =
      benchmark::Counter(static_cast<double>(state.range(0)) * 1e-9,
                         benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  }
} // namespace

int
main(int argc, char **argv)
{
  int one = 1;
  const dealii::Utilities::MPI::MPI_InitFinalize guard(one, argv, 1);
  for (const double accuracy : {1e-4, 1e-6, 1e-9})
  {
    const std::string name = fmt::format("{:.0e}", accuracy).replace(3, 1, ""); // 1e-4
    benchmark::RegisterBenchmark(("run/petsc/" + name).c_str(), run_petsc, accuracy)->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("run/rule/" + name).c_str(), run_rule, accuracy)->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark(("run/pilot/" + name).c_str(), run_pilot, accuracy)->Unit(benchmark::kMillisecond);
  }
  const auto add_kernel = [](const char *name, const std::function<void(Bench &)> &action)
  {
    benchmark::RegisterBenchmark(name, kernel, action)->Arg(12)->Arg(1200)->Unit(benchmark::kMicrosecond);
  };
  add_kernel("kernel/residual",
             [](Bench &b)
             {
               b.assembler.residual(0.3, b.u, b.v, b.F);
             });
  add_kernel("kernel/jacobian",
             [](Bench &b)
             {
               b.assembler.jacobian(0.3, b.u, b.v, 100., b.matrix);
             });
  add_kernel("kernel/elimination",
             [](Bench &b)
             {
               b.matrix.factorize();
             });
  add_kernel("kernel/solution",
             [](Bench &b)
             {
               b.matrix.solve(b.F, b.F);
             });
  add_kernel("kernel/velocity",
             [](Bench &b)
             {
               b.assembler.velocity(0.3, b.u, b.v);
             });
  benchmark::RegisterBenchmark("kernel/expression/bulk", expression_bulk)->Arg(12)->Arg(1200);
  benchmark::RegisterBenchmark("kernel/expression/construction", expression_construction)->Arg(12)->Arg(1200);
  benchmark::RegisterBenchmark("scale/newton_step", newton_step)
    ->RangeMultiplier(10)
    ->Range(10, 100000)
    ->Arg(500000)
    ->Unit(benchmark::kMicrosecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
