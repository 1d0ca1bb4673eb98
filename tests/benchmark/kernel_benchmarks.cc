// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What the parts of a run by PETSc cost.
#include "../support/run_text.h"
#include "benchmarks.h"

#include <crawler/equation/position_form.h>
#include <crawler/scene/active_stress/expression.h>

#include <benchmark/benchmark.h>

namespace crawler::test
{
  namespace
  {
    /// Everything that a kernel needs.
    struct Bench
    {
      Bench(const unsigned int n_cells, const unsigned int degree)
        : scene(parameters_with(wave(-1., 0.4)).create_scene())
        , discretization(MPI_COMM_WORLD, 1., n_cells, degree)
        , assembler(scene, discretization)
        , matrix(discretization)
        , u(discretization.n_owned())
        , v(u)
        , F(u)
      {
        assembler.residual(0.3, u, v, F);
        assembler.jacobian(0.3, u, v, 1., 100., matrix);
        matrix.factorize();
      }
      Scene scene;
      Discretization discretization;
      PositionForm assembler;
      BlockTridiagonalMatrix<double> matrix;
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

    /// Values of a stress at all times of a run.
    void
    stress_values(benchmark::State &state, const ActiveStress &stress)
    {
      const auto points    = stress_points(static_cast<std::size_t>(state.range(0)));
      const auto at_points = stress.at(points);
      std::vector<double> m(points.size());
      double t = 0.;
      for (auto _ : state)
      {
        at_points->values(t += 1e-3, m);
        t = t > 1. ? 0. : t;
        benchmark::DoNotOptimize(m.data());
      }
      state.SetItemsProcessed(state.iterations() * state.range(0) * 5);
    }

    /// What is prepared for a mesh.
    void
    stress_construction(benchmark::State &state, const ActiveStress &stress)
    {
      const auto points = stress_points(static_cast<std::size_t>(state.range(0)));
      for (auto _ : state)
        benchmark::DoNotOptimize(stress.at(points));
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
        bench.assembler.jacobian(t, bench.u, bench.v, 1., 100., bench.matrix);
        bench.matrix.factorize();
        bench.matrix.solve(bench.F, bench.F);
      }
      state.SetItemsProcessed(state.iterations());
    }
  } // namespace

  void
  add_kernel_benchmarks()
  {
    const auto add_kernel = [](const char *name, const std::function<void(Bench &)> &action) {
      benchmark::RegisterBenchmark(name, kernel, action)->Arg(12)->Arg(1200)->Unit(benchmark::kMicrosecond);
    };
    add_kernel("kernel/residual", [](Bench &b) { b.assembler.residual(0.3, b.u, b.v, b.F); });
    add_kernel("kernel/jacobian", [](Bench &b) { b.assembler.jacobian(0.3, b.u, b.v, 1., 100., b.matrix); });
    add_kernel("kernel/elimination", [](Bench &b) { b.matrix.factorize(); });
    add_kernel("kernel/solution", [](Bench &b) { b.matrix.solve(b.F, b.F); });
    add_kernel("kernel/velocity", [](Bench &b) { b.assembler.velocity(0.3, b.u, b.v); });
    const auto add_formula = [](const char *name, const auto &action) {
      const auto stress =
        std::make_shared<const Expression>(ExpressionParameters{.active_stress = "0.1*sin(2*pi*(s+t))"}, 1., 1.);
      benchmark::RegisterBenchmark(name, [=](benchmark::State &state) { action(state, *stress); })->Arg(12)->Arg(1200);
    };
    add_formula("kernel/expression/bulk", stress_values);
    add_formula("kernel/expression/construction", stress_construction);
    benchmark::RegisterBenchmark("scale/newton_step", newton_step)->Arg(500000)->Unit(benchmark::kMicrosecond);
  }
} // namespace crawler::test
