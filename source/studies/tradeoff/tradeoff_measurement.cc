// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/base/clock.h>
#include <crawler/base/exceptions.h>
#include <crawler/run/batch.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/studies/core/form.h>
#include <crawler/studies/sweep/point_table.h>
#include <crawler/studies/tradeoff/tradeoff_measurement.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>

#ifdef __GLIBC__
#  include <malloc.h>
#endif

namespace crawler
{
  namespace
  {
    /// Shortest measurement [s]; faster runs are repeated.
    constexpr double shortest_measurement = 5e-3;
    /// Duration [s] beyond which the first run of a setting counts as a measurement.
    constexpr double long_run        = 0.1;
    constexpr std::size_t batch_size = 8;
    /// Number of steps after each of which the heap is examined, and interval in steps afterwards.
    constexpr unsigned long looks_at_heap = 64, steps_between_looks = 16;

    /// Processor time of this process [s].
    double
    processor_seconds()
    {
      return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    }

    /// Bytes of the heap in use; not a number where the C library does not tell (glibc does).
    double
    heap_bytes()
    {
#ifdef __GLIBC__
      const struct mallinfo2 info = mallinfo2();
      return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
#else
      return std::nan("");
#endif
    }

    struct Run
    {
      const Scene &scene;
      Parameters parameters;
      bool is_batch;
      Numerics numerics = {};

      /// Computes one run on this level or mesh, or a batch of identical runs, of which the first is returned.
      SimulationResult
      operator()(const std::function<bool()> &keep_going) const
      {
        const bool energy_balance = parameters.output.energy_balance;
        if (parameters.model != Model::nonlinear)
          return ReducedModel(scene, parameters.model).compute(parameters.accuracy, energy_balance, keep_going);
        // Single runs are those of crawler run, whose steps end where the last stride begins.
        const auto gait                   = is_batch ? Simulation::GaitWish::none : Simulation::GaitWish::any;
        const Simulation::Options options = {.energy_balance = energy_balance, .gait = gait};
        if (!is_batch)
          return Simulation(MPI_COMM_SELF, scene, parameters.time, numerics).run({}, options, {}, keep_going);
        const std::vector<BatchRun> runs(batch_size, {&scene, &parameters.time, &numerics});
        if (auto results = run_batch(runs, options, keep_going); results[0])
          return std::move(*results[0]);
        SimulationResult given_up;
        given_up.time.status  = Status::failed;
        given_up.time.reason  = "gave_up";
        given_up.time.message = "the batch engine gave up; the run needs an engine for single runs";
        return given_up;
      }
    };

    TradeoffTexts
    row_of(const TimeOutcome &outcome)
    {
      return gap(word_of(outcome.status), outcome.reason, outcome.message);
    }

    /// Times the runs; returns false if it was interrupted.
    bool
    time_runs(TradeoffTexts &row, const Run &run, const double first_seconds, const std::function<bool()> &interrupted)
    {
      const double n_bodies = run.is_batch ? batch_size : 1.;
      const bool is_long    = first_seconds > long_run;
      std::vector<double> seconds(is_long ? 1 : 0, first_seconds / n_bodies);
      auto repetitions = static_cast<double>(seconds.size());
      // Short runs are not interrupted: the checks would be a part of their cost.
      const auto keep_going = is_long ? std::function<bool()>([&]() { return !interrupted(); }) : nullptr;
      while (seconds.size() < run.parameters.tradeoff.repetitions)
      {
        const double start = processor_seconds();
        double n           = 0.;
        double passed      = 0.;
        for (; passed < shortest_measurement; passed = processor_seconds() - start)
        {
          run(keep_going);
          ++n;
        }
        seconds.push_back(passed / (n * n_bodies));
        repetitions += n;
        if (interrupted())
          return false;
      }
      std::ranges::sort(seconds);
      const std::size_t n = seconds.size();
      const double median = 0.5 * (seconds[(n - 1) / 2] + seconds[n / 2]);
      row["repetitions"]  = to_text(repetitions);
      row["seconds"]      = to_text(median);
      row["spread"]       = to_text((seconds.back() - seconds.front()) / median);
      return true;
    }

    /// Measures the row, without the entries. Failures are thrown.
    std::optional<TradeoffTexts>
    measured(Run run, const bool is_adaptive, const std::function<bool()> &interrupted)
    {
      const double limit = run.parameters.tradeoff.run_time_limit, end = now() + limit;
      const auto late = [&]() {
        auto row = gap("stopped", time_limit_reason, fmt::format("stopped after {:g} s", limit), limit);
        return interrupted() ? std::nullopt : std::optional(row);
      };
      const double start = processor_seconds();
      if (run.parameters.model == Model::nonlinear)
      {
        const auto in_time = [&]() { return now() < end && !interrupted(); };
        const auto choice  = choose_numerics(MPI_COMM_SELF, run.parameters, run.scene, in_time);
        if (!choice)
          return late();
        run.numerics = choice->numerics;
      }
      const double heap_before = heap_bytes(), start_of_run = processor_seconds();
      double max_heap            = heap_before;
      unsigned long n_steps      = 0;
      bool is_out_of_time        = false;
      auto result                = run([&]() {
        if (++n_steps <= looks_at_heap || n_steps % steps_between_looks == 0)
          max_heap = std::fmax(max_heap, heap_bytes());
        is_out_of_time = now() > end;
        return !is_out_of_time && !interrupted();
      });
      const double first_seconds = processor_seconds() - start_of_run;
      if (is_out_of_time)
        return late();
      if (interrupted())
        return std::nullopt;
      check_identities(result, run.parameters);
      TradeoffTexts row = row_of(result.time);
      if (is_adaptive)
        row["choice seconds"] = to_text(start_of_run - start);
      if (run.parameters.model == Model::nonlinear)
      {
        row["steps"]             = to_text(result.time.steps);
        row["rejected steps"]    = to_text(result.time.rejected_steps);
        row["newton iterations"] = to_text(result.time.newton_iterations);
        row["most cells"]        = to_text(std::max(result.most_cells, run.numerics.n_cells));
      }
      // Levels that miss the requested accuracy have an answer all the same; its message says so.
      const bool misses_accuracy = result.time.reason == "accuracy_not_met" && std::isfinite(result.displacement);
      if (result.time.status != Status::finished && !misses_accuracy)
        return row;
      row["status"]       = "finished";
      row["reason"]       = "";
      row["message"]      = misses_accuracy ? result.time.message : "";
      row["displacement"] = to_text(result.displacement);
      row["memory"]       = to_text(max_heap - heap_before);
      return time_runs(row, run, first_seconds, interrupted) ? std::optional(row) : std::nullopt;
    }
  } // namespace

  TradeoffTexts
  gap(const std::string &status, const std::string &reason, const std::string &message, const double limit)
  {
    return {{"status", status},
            {"reason", reason},
            {"message", message},
            {"time limit", to_text(limit)},
            {"below bar", "false"}};
  }

  std::optional<TradeoffTexts>
  measure(const Input &input,
          const TradeoffSetting &setting,
          const std::vector<std::string> &overrides,
          const std::function<bool()> &interrupted)
  {
    if (!setting.not_offered.empty())
      return gap("not offered", "not_offered", setting.not_offered);
    try
    {
      ParameterFile file = input.file;
      for (const std::string &one : overrides)
        file.add_override(one);
      const Run run{input.scene, Form(file).parameters, setting["engine"] == "batch"};
      return measured(run, setting["mesh"] == "adaptive", interrupted);
    }
    catch (const InputError &error)
    {
      return gap("refused", "inadmissible", error.what());
    }
    catch (...)
    {
      return row_of(failure_of(std::current_exception()));
    }
  }
} // namespace crawler
