// SPDX-License-Identifier: LGPL-2.1-or-later
//
// A study over two parameters by batches.
#include "batch_scenes.h"
#include "benchmarks.h"

#include <benchmark/benchmark.h>

#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace crawler::test
{
  namespace
  {
    constexpr std::size_t n_exponents = 40, n_chi = 25;

    struct Outcome
    {
      std::vector<double> displacements; ///< not a number where a run failed
      std::size_t given_back = 0;
    };

    /// A batch, and each of the runs that it gives back by a Simulation.
    Outcome
    compute(const std::vector<Scene> &scenes, const Setting &setting, const std::vector<std::size_t> &members)
    {
      Outcome outcome;
      std::vector<BatchRun> runs;
      for (const std::size_t i : members)
        runs.push_back({&scenes[i], &setting.time, &setting.numerics});
      const auto results = run_batch(runs, {});
      for (std::size_t i = 0; i < members.size(); ++i)
      {
        if (results[i])
        {
          outcome.displacements.push_back(results[i]->displacement);
          continue;
        }
        ++outcome.given_back;
        Simulation simulation(MPI_COMM_WORLD, scenes[members[i]], setting.time, setting.numerics);
        const auto result = simulation.run({}, {});
        outcome.displacements.push_back(result.time.status == Status::finished ? result.displacement : std::nan(""));
      }
      return outcome;
    }

    Setting
    fine(const unsigned int degree, const unsigned int n_cells, const double tolerance)
    {
      Setting setting;
      setting.time.integrator = "radau 9";
      setting.numerics        = {degree, n_cells, tolerance, 1e-2};
      return setting;
    }

    double
    largest_difference(const std::vector<double> &values,
                       const std::vector<double> &exact,
                       const std::vector<std::size_t> &members)
    {
      double largest = 0.;
      for (std::size_t i = 0; i < members.size(); ++i)
      {
        const double error = std::abs(values[i] / exact[members[i]] - 1.);
        largest            = std::isfinite(error) ? std::max(largest, error) : HUGE_VAL;
      }
      return largest;
    }

    std::vector<std::size_t>
    numbers_below(const std::size_t n)
    {
      std::vector<std::size_t> numbers(n);
      std::iota(numbers.begin(), numbers.end(), 0);
      return numbers;
    }

    /// The 1000 scenes, and what is known of them from runs that are far more accurate.
    struct Sweep
    {
      const std::vector<Scene> scenes        = grid_of_scenes(n_exponents, n_chi);
      const std::vector<std::size_t> members = numbers_below(scenes.size());
      const std::vector<double> exact        = compute(scenes, fine(8, 10, 1e-11), members).displacements;
      const double reference_error =
        largest_difference(compute(scenes, fine(7, 10, 1e-10), members).displacements, exact, members);
    };

    const Sweep &
    sweep()
    {
      static const Sweep result;
      return result;
    }

    double
    largest_error(const Setting &setting, const std::vector<std::size_t> &members)
    {
      return largest_difference(compute(sweep().scenes, setting, members).displacements, sweep().exact, members);
    }

    /// Each half of the perturbation parameters has its own setting, as Accuracy would choose one for each scene.
    struct Half
    {
      std::vector<std::size_t> members;
      Setting setting;
    };

    std::vector<std::size_t>
    members_of_half(const bool upper)
    {
      std::vector<std::size_t> members;
      for (const std::size_t i : sweep().members)
        if ((i % n_chi >= n_chi / 2) == upper)
          members.push_back(i);
      return members;
    }

    /// Compares settings with some of the scenes; all must be right.
    Setting
    search(const double wanted, const std::vector<std::size_t> &members)
    {
      std::vector<std::size_t> some;
      for (std::size_t i = 0; i < members.size(); i += 7)
        some.push_back(members[i]);
      some.push_back(members.back());
      const auto prepare = [&](const Setting &setting) {
        return [&some, setting]() { return largest_error(setting, some); };
      };
      const SearchSpace space{.engine      = "automatic",
                              .integrators = {"radau 9", "radau 5"},
                              .degrees     = {6, 7, 5},
                              .cells       = {8, 7, 6, 5, 4, 3, 2},
                              .loosest     = wanted,
                              .tightest    = 1e-4 * wanted,
                              .end_time    = 1.};
      return cheapest_setting(
        space, wanted, prepare, [&](const Setting &setting) { return largest_error(setting, members) <= wanted; });
    }

    const std::array<Half, 2> &
    cheapest(const double wanted)
    {
      static std::map<double, std::array<Half, 2>> known;
      if (!known.contains(wanted))
        for (const bool upper : {false, true})
        {
          const auto members   = members_of_half(upper);
          known[wanted][upper] = {members, search(wanted, members)};
        }
      return known.at(wanted);
    }

    void
    run_sweep(benchmark::State &state, const double wanted)
    {
      const auto &halves = cheapest(wanted);
      std::array<Outcome, 2> outcomes;
      for (auto _ : state)
        for (const bool upper : {false, true})
          outcomes[upper] = compute(sweep().scenes, halves[upper].setting, halves[upper].members);
      state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(sweep().members.size()));
      state.SetLabel("small chi: " + in_words(halves[0].setting) + "; large chi: " + in_words(halves[1].setting));
      double error = 0., given_back = 0.;
      for (const bool upper : {false, true})
      {
        error =
          std::max(error, largest_difference(outcomes[upper].displacements, sweep().exact, halves[upper].members));
        given_back += static_cast<double>(outcomes[upper].given_back);
      }
      state.counters["error"]           = error;
      state.counters["reference_error"] = sweep().reference_error;
      state.counters["given_back"]      = given_back;
    }
  } // namespace

  void
  add_sweep_benchmarks()
  {
    benchmark::RegisterBenchmark("sweep/1e-4", run_sweep, 1e-4)->Unit(benchmark::kMillisecond);
    benchmark::RegisterBenchmark("sweep/1e-6", run_sweep, 1e-6)->Unit(benchmark::kMillisecond);
  }
} // namespace crawler::test
