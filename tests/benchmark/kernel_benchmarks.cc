// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What the parts of a run by PETSc cost.
#include "../support/run_text.h"
#include "../support/temporary_folder.h"
#include "benchmarks.h"

#include <crawler/equation/position_form.h>
#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/table.h>

#include <benchmark/benchmark.h>

#include <cmath>
#include <numbers>

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

    /// A CSV file with n_s x n_t samples of a wave, for the life of this object.
    class TableFile
    {
    public:
      TableFile(const unsigned int n_s, const unsigned int n_t)
      {
        std::string rows = "s,t,m\n";
        for (unsigned int j = 0; j < n_t; ++j)
          for (unsigned int i = 0; i < n_s; ++i)
          {
            const double s = i / (n_s - 1.), t = j / (n_t - 1.);
            rows += fmt::format("{},{},{}\n", s, t, 0.1 * std::sin(2. * std::numbers::pi * (s + t)));
          }
        write_file(folder_.path / "m.csv", rows);
      }

      ActiveStressTable
      read(const std::string &interpolation) const
      {
        return {{.file = folder_.path / "m.csv", .interpolation = interpolation}, 1., 1.};
      }

    private:
      const TemporaryFolder folder_;
    };

    /// Rows of 1000 x 1000 samples in a second.
    void
    table_reading(benchmark::State &state)
    {
      const TableFile file(1000, 1000);
      for (auto _ : state)
        benchmark::DoNotOptimize(file.read("cubic"));
      state.SetItemsProcessed(state.iterations() * 1000000);
    }

    template <typename Function, typename Stress>
    void
    add(const std::string &name, const Function &function, const Stress &make_stress)
    {
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State &state) { function(state, *make_stress()); })
        ->Arg(12)
        ->Arg(1200);
    }

    void
    add_generators()
    {
      for (const auto &[name, settings] :
           {std::pair("travelling_wave", "travelling wave"),
            {"smoothed_square", "travelling wave; Profile = smoothed square"},
            {"standing_wave", "standing wave"},
            {"pulse", "pulse"},
            {"optimal_wave", "optimal wave"},
            {"shaped_wave", "c = 1; optimal wave; Shape = expression; Shape formula = exp(-(x/0.1)^2)"},
            {"formula_of_shaped_wave",
             "expression; Active stress = 0.4*(0.0886*(erf(10*(s+t)) - erf(10*t) - s*(erf(10*(1+t)) - erf(10*t))) - "
             "exp(-100*(s+t)^2) + exp(-100*s^2))"}})
        add(std::string("kernel/") + name + "/values", stress_values, [settings = settings]() {
          return parameters_with(set(settings)).create_scene().active_stress;
        });
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
    const auto expression = []() {
      return std::make_unique<Expression>(ExpressionParameters{.active_stress = "0.1*sin(2*pi*(s+t))"}, 1., 1.);
    };
    add("kernel/expression/bulk", stress_values, expression);
    add("kernel/expression/construction", stress_construction, expression);
    add_generators();
    // To be compared with kernel/expression/bulk.
    const auto table = [](const std::string &interpolation) {
      return [=]() { return std::make_unique<ActiveStressTable>(TableFile(65, 129).read(interpolation)); };
    };
    add("kernel/table/cubic", stress_values, table("cubic"));
    add("kernel/table/linear", stress_values, table("linear"));
    add("kernel/table/construction", stress_construction, table("cubic"));
    benchmark::RegisterBenchmark("kernel/table/reading", table_reading)->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("scale/newton_step", newton_step)->Arg(500000)->Unit(benchmark::kMicrosecond);
  }
} // namespace crawler::test
