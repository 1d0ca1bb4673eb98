// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Whole runs of one case to a given error, one at a time or side by side.
#include "batch_scenes.h"
#include "benchmarks.h"

#include <crawler/accuracy/run_to_accuracy.h>

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>

namespace crawler::test
{
  namespace
  {
    /// A problem with a known answer.
    struct Case
    {
      std::string name;
      Settings settings;
      double displacement; ///< doc/theory.md, section 5, and contrib/reference/table.json
      double end_time;
      std::size_t batch_size;
      std::vector<unsigned int> cells; ///< to choose from
      double tolerance_factor = 0.66;  ///< between the tolerances to choose from
    };

    const Case fig_s1{"run", wave(-1., 0.4), 9.007252980024e-2, 1., 4096, {12, 10, 8, 7, 6, 5, 4, 3, 2}};
    const Case fig_2{"fig2", wave(-1., 0.4, 1., 20.), 1.8019682398008, 20., 512, {7, 6, 5, 4}, 0.5};
    /// The displacement is that of runs of degree 8 with 10 and 14 cells and a tolerance of 1e-13, by both engines.
    const Case stiff{"stiff", wave(-1., 0.3, 1., 1., 100.), 4.860527262566e-2, 1., 4096, {10, 8, 6, 5, 4, 3, 2}};
    // The displacements of these are those of contrib/reference/table.json.
    const Case slippery{"a=-3", wave(-3., 0.3), 0.11186924764530372, 1., 4096, {16, 12, 10, 8, 7, 6, 5, 4, 3, 2}};
    const Case sticky{"a=2", wave(2., 0.3), -0.08107086824722676, 1., 4096, {12, 10, 8, 7, 6, 5, 4, 3, 2}};

    double
    error_of(const SimulationResult &result, const double exact)
    {
      return result.time.status == Status::finished ? std::abs(result.displacement / exact - 1.) : HUGE_VAL;
    }

    double
    error_of(const std::optional<SimulationResult> &result, const double exact)
    {
      return result ? error_of(*result, exact) : HUGE_VAL;
    }

    /// Simulations of one body, which are run again and again.
    struct OneBody
    {
      OneBody(const Case &body, const Setting &chosen)
        : setting(chosen)
        , scene(parameters_with(body.settings).create_scene())
        , simulation(MPI_COMM_WORLD, scene, setting.time, setting.numerics)
      {
      }

      const Setting setting;
      const Scene scene;
      Simulation simulation;
    };

    /// "petsc", "fused" or "batch".
    using Way = std::string;

    SearchSpace
    search_space(const Case &body, const Way &way, const double wanted)
    {
      SearchSpace space{.engine           = way == "petsc" ? "petsc" : "automatic",
                        .integrators      = {"radau 9", "radau 5"},
                        .degrees          = {6, 7, 5, 4},
                        .cells            = body.cells,
                        .loosest          = std::min(3e-3, 1e5 * wanted),
                        .tightest         = 1e-3 * wanted * std::abs(body.displacement),
                        .end_time         = body.end_time,
                        .tolerance_factor = body.tolerance_factor};
      if (way == "petsc")
        space.integrators.emplace_back("bdf");
      return space;
    }

    Prepare
    one_body(const Case &body)
    {
      return [&body](const Setting &setting) {
        return [&body, own = std::make_shared<OneBody>(body, setting)]() {
          return error_of(own->simulation.run({}, {}), body.displacement);
        };
      };
    }

    Prepare
    small_batch(const Case &body)
    {
      static constexpr std::size_t size = 64;
      const auto scenes =
        std::make_shared<const std::vector<Scene>>(similar_scenes(parameters_with(body.settings), size));
      return [&body, scenes](const Setting &setting) {
        return [&body, scenes, setting]() { return error_of(run_scenes(*scenes, setting)[0], body.displacement); };
      };
    }

    /// The cheapest setting. An error that is small by luck does not count: smaller tolerances must reach it as well.
    Setting
    search(const Case &body, const Way &way, const double wanted)
    {
      const Prepare prepare = way == "batch" ? small_batch(body) : one_body(body);
      const auto confirm    = [&](Setting setting) {
        for (int i = 0; i < 3; ++i)
        {
          setting.numerics.tolerance *= 0.6;
          if (!(prepare(setting)() <= wanted))
            return false;
        }
        return true;
      };
      return cheapest_setting(search_space(body, way, wanted), wanted, prepare, confirm);
    }

    /// The search is made once for all benchmarks of this process.
    const Setting &
    cheapest(const Case &body, const Way &way, const double wanted)
    {
      static std::map<std::string, Setting> known;
      const std::string key = fmt::format("{} {} {:g}", body.name, way, wanted);
      if (!known.contains(key))
        known.emplace(key, search(body, way, wanted));
      return known.at(key);
    }

    void
    show(benchmark::State &state, const Setting &setting, const double error, const SimulationResult &result)
    {
      state.SetLabel(in_words(setting));
      state.counters["error"] = error;
      state.counters["steps"] = result.time.steps;
    }

    void
    run_one(benchmark::State &state, const Case &body, const Way &way, const double accuracy)
    {
      OneBody own(body, cheapest(body, way, accuracy));
      SimulationResult result;
      for (auto _ : state)
        result = own.simulation.run({}, {});
      state.SetItemsProcessed(state.iterations());
      show(state, own.setting, error_of(result, body.displacement), result);
    }

    void
    run_many(benchmark::State &state,
             const Case &body,
             const double accuracy,
             const RecordOptions &options,
             const LaneEngine &engine)
    {
      const Setting &setting = cheapest(body, "batch", accuracy);
      const auto scenes      = similar_scenes(parameters_with(body.settings), body.batch_size);
      BatchResults results;
      for (auto _ : state)
        results = run_scenes(scenes, setting, options, engine);
      state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scenes.size()));
      if (std::count(results.begin(), results.end(), std::nullopt) > 0)
        state.SkipWithError("runs were given back");
      else
        show(state, setting, error_of(results[0], body.displacement), *results[0]);
    }

    /// What `Accuracy` delivers: choice, run with the energy balance, bounds of the errors; "ratio" is its time over
    /// that of the cheapest fixed setting, which knows nothing of its error.
    void
    run_answer(benchmark::State &state, const Case &body, const double accuracy)
    {
      const auto parameters = parameters_with(with(body.settings, "Accuracy = {}", accuracy));
      const Scene scene     = parameters.create_scene();
      OneBody own(body, cheapest(body, "fused", accuracy));
      using Clock = std::chrono::steady_clock;
      std::vector<double> answers, cheapest;
      Answer answer;
      for (auto _ : state)
      {
        const auto start = Clock::now();
        answer           = answer_in_memory({parameters, scene}, {.energy_balance = true});
        const auto end   = Clock::now();
        state.PauseTiming();
        own.simulation.run({}, {});
        answers.push_back(std::chrono::duration<double>(end - start).count());
        cheapest.push_back(std::chrono::duration<double>(Clock::now() - end).count());
        state.ResumeTiming();
      }
      const auto least = [](const std::vector<double> &times) { return *std::ranges::min_element(times); };
      state.SetItemsProcessed(state.iterations());
      show(state, {parameters.time, answer.choice.numerics}, error_of(answer.result, body.displacement), answer.result);
      state.counters["ratio"] = least(answers) / least(cheapest);
      state.counters["bound"] =
        answer.result.error ? answer.result.error->total / std::abs(answer.result.displacement) : HUGE_VAL;
    }

    /// Robot of segments that switch by jumps, with cells graded towards all of them, for one period.
    void
    run_robot(benchmark::State &state, const unsigned int n_segments, const double accuracy)
    {
      const auto parameters =
        parameters_with(set("Accuracy = {}; segments; Number of segments = {}; Amplitude = 0.3; Frequency = 1; "
                            "Phase lag = {}; Duty cycle = 0.5",
                            accuracy,
                            n_segments,
                            1. / n_segments));
      const Scene scene = parameters.create_scene();
      Answer answer;
      for (auto _ : state)
        answer = answer_in_memory({parameters, scene}, {.energy_balance = true});
      state.counters["cells"] = answer.result.process.mesh.most_cells;
      state.counters["steps"] = answer.result.time.steps;
      state.counters["bound"] = answer.result.error ? answer.result.error->total : HUGE_VAL;
    }

    /// Bodies and grounds that are not plain, all with the same setting, to be compared with the plain one.
    std::map<std::string, Settings>
    general_bodies()
    {
      return {{"plain", {}},
              {"profiles", {{"Body/Elastic modulus profile", "1+0.3*s"}, {"Body/Friction profile", "1.2-0.3*s"}}},
              {"friction_law", {{"Ground/Friction law", "expression"}, {"Ground/Expression", "0.3+0.7/w^1.5"}}},
              {"direction", {{"Ground/Backward ratio", "3"}, {"Ground/Switching velocity", "0.5"}}},
              {"ground", {{"Ground/Profile", "1+0.2*tanh(x)"}}},
              {"feedback", set("strain feedback; Active stress = 0.3*sin(2*pi*(s+t))*s*(1-s)*4-0.1*(w-1)+0.05*w_t")}};
    }

    Setting
    setting_of_general_bodies(const Parameters &parameters)
    {
      Setting setting{parameters.time,
                      {.degree = 6, .n_cells = 5, .tolerance = 1e-6, .initial_step = 1e-3, .integrator = "radau 5"}};
      setting.time.integrator = "radau 5";
      return setting;
    }

    void
    run_general(benchmark::State &state, const Settings &laws)
    {
      const Settings settings = with(wave(-1., 0.3), laws);
      const Case body{"general", settings, 1., 1., 0, {}};
      OneBody own(body, setting_of_general_bodies(parameters_with(settings)));
      SimulationResult result;
      for (auto _ : state)
        result = own.simulation.run({}, {});
      state.counters["steps"] = result.time.steps;
      if (result.process.engine != "fused")
        state.SkipWithError("not by the fused engine");
    }

    void
    run_general_batch(benchmark::State &state, const Settings &laws)
    {
      const Parameters parameters = parameters_with(with(wave(-1., 0.3), laws));
      const auto scenes           = similar_scenes(parameters, 256);
      const Setting setting       = setting_of_general_bodies(parameters);
      BatchResults results;
      for (auto _ : state)
        results = run_scenes(scenes, setting);
      state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(scenes.size()));
      if (std::count(results.begin(), results.end(), std::nullopt) > 0)
        state.SkipWithError("runs were given back");
    }

    template <typename... Arguments>
    void
    add(const std::string &name, const Arguments &...arguments)
    {
      benchmark::RegisterBenchmark(name.c_str(), arguments...)->Unit(benchmark::kMillisecond);
    }

    void
    add_fig_s1(const double accuracy)
    {
      const std::string end = fmt::format("/{:.0e}", accuracy).replace(4, 1, ""); // /1e-4
      add("run/petsc" + end, run_one, fig_s1, "petsc", accuracy);
      add("run/fused" + end, run_one, fig_s1, "fused", accuracy);
      const auto add_batch = [&](const std::string &name, const LaneEngine *engine, const RecordOptions &options) {
        if (engine != nullptr)
          add(name + end, run_many, fig_s1, accuracy, options, *engine);
      };
      add_batch("run/batch", &batch_engine(), {});
      add_batch("run/batch_avx2", batch_engine("avx2"), {});
      add_batch("run/batch_baseline", batch_engine("baseline"), {});
      add_batch("run/batch_energy_balance", &batch_engine(), {.energy_balance = true});
      for (const Case &body : {fig_s1, stiff, slippery, sticky, fig_2})
        add("answer/" + body.name + end, run_answer, body, accuracy);
    }
  } // namespace

  void
  add_run_benchmarks()
  {
    for (const double accuracy : {1e-4, 1e-6, 1e-9})
      add_fig_s1(accuracy);
    for (int i = 1; i <= 10; ++i) // contrib/peers/trade.py
    {
      const double accuracy = std::pow(10., -i);
      add(fmt::format("front/engine/1e-{}", i), run_one, fig_s1, "fused", accuracy);
      add(fmt::format("front/answer/1e-{}", i), run_answer, fig_s1, accuracy);
    }
    for (const Case &body : {fig_2, stiff})
    {
      const std::string name = "case/" + body.name + "/1e-6";
      add(name + "/petsc", run_one, body, "petsc", 1e-6);
      add(name + "/fused", run_one, body, "fused", 1e-6);
      benchmark::RegisterBenchmark((name + "/batch").c_str(), run_many, body, 1e-6, RecordOptions(), batch_engine())
        ->Unit(benchmark::kMillisecond);
    }
    for (const unsigned int n_segments : {8, 64})
      for (const double accuracy : {1e-4, 1e-6})
        add("robot/" + std::to_string(n_segments) + "/" + text(accuracy), run_robot, n_segments, accuracy);
    for (const auto &[name, laws] : general_bodies())
    {
      add("general/" + name + "/fused", run_general, laws);
      add("general/" + name + "/batch", run_general_batch, laws);
    }
  }
} // namespace crawler::test
