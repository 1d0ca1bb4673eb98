// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/exceptions.h>
#include <crawler/run/batch.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/studies/core/study.h>
#include <crawler/studies/tradeoff/tradeoff_measurement.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#ifdef __GLIBC__
#  include <malloc.h>
#endif

namespace crawler
{
  namespace
  {
    /// A measurement takes at least this long; runs that are faster are repeated [s].
    constexpr double shortest_measurement = 5e-3;
    /// The first run of a setting counts as a measurement if it takes longer than this [s].
    constexpr double long_run = 0.1;
    /// Bodies side by side.
    constexpr std::size_t batch_size = 8;
    /// The heap is looked at after each of so many steps, and then after every so many.
    constexpr unsigned long looks_at_heap = 64, steps_between_looks = 16;
  } // namespace

  double
  processor_seconds()
  {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  }

  double
  heap_bytes()
  {
#ifdef __GLIBC__
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
#else
    return TradeoffRow::unknown;
#endif
  }

  TradeoffMeasurement::TradeoffMeasurement(const Parameters &parameters,
                                           const Scene &scene,
                                           const double size,
                                           std::function<bool()> interrupted)
    : parameters_(parameters)
    , scene_(scene)
    , size_(size)
    , interrupted_(std::move(interrupted))
  {
  }

  /// One run on this level or mesh, or a batch of runs that are all alike, of which the first is returned.
  SimulationResult
  TradeoffMeasurement::run(const Parameters &own, const Numerics &numerics, const KeepGoing &keep_going) const
  {
    // A single run is that of crawler run, whose steps end where the last stride begins.
    const Simulation::Options options = {.energy_balance = own.output.energy_balance,
                                         .gait           = setting_.is_batch() ? Simulation::GaitWish::none
                                                                               : Simulation::GaitWish::any};
    if (setting_.has_no_mesh())
      return ReducedModel(scene_, own.model).compute(own.accuracy, own.output.energy_balance, keep_going);
    if (!setting_.is_batch())
    {
      Simulation simulation(MPI_COMM_SELF, scene_, own.time, numerics);
      return simulation.run({}, options, {}, keep_going);
    }
    const std::vector<BatchRun> runs(batch_size, {&scene_, &own.time, &numerics});
    auto results = run_batch(runs, options, keep_going);
    if (results[0])
      return std::move(*results[0]);
    SimulationResult given_up;
    given_up.time.status  = Status::failed;
    given_up.time.reason  = "gave_up";
    given_up.time.message = "the batch engine gave the run up, which then is for a single run";
    return given_up;
  }

  std::optional<TradeoffRow>
  TradeoffMeasurement::measure(const TradeoffSetting &setting)
  {
    took_too_long_ = took_too_long_ && same_mesh(setting, setting_);
    setting_       = setting;
    TradeoffRow row;
    row.setting = setting;
    if (!setting.not_offered.empty())
    {
      row.not_computed("not offered", "not_offered", setting.not_offered);
      return row;
    }
    if (took_too_long_)
    {
      row.not_computed("stopped", time_limit_reason, "not tried: a looser tolerance on this mesh took too long");
      return row;
    }
    try
    {
      if (!measure(row))
        return std::nullopt;
    }
    catch (const InputError &error)
    {
      row.not_computed("refused", "inadmissible", error.what());
    }
    catch (const FileError &error)
    {
      row.not_computed("failed", "exception", error.what());
    }
    catch (...)
    {
      const TimeOutcome failure = failure_of(std::current_exception());
      row.not_computed(word_of(failure.status), failure.reason, failure.message);
    }
    return row;
  }

  /// Fills the row; false if it was interrupted.
  bool
  TradeoffMeasurement::measure(TradeoffRow &row)
  {
    const double limit = parameters_.tradeoff.run_time_limit, end = now() + limit;
    const Parameters own = with_setting(parameters_, row.setting, size_);
    const auto too_long  = [&]() {
      row.not_computed("stopped", time_limit_reason, fmt::format("stopped after {:g} s", limit));
      took_too_long_ = true;
      return !interrupted_();
    };
    Numerics numerics;
    if (!setting_.has_no_mesh())
    {
      const double start_of_choice = processor_seconds();
      const auto choice = choose_numerics(MPI_COMM_SELF, own, scene_, [&]() { return now() < end && !interrupted_(); });
      if (!choice)
        return too_long();
      numerics = choice->numerics;
      if (setting_.mesh == "adaptive")
        row.choice_seconds = processor_seconds() - start_of_choice;
    }

    const double heap_before   = heap_bytes();
    double most_heap           = heap_before;
    unsigned long n_steps      = 0;
    bool is_out_of_time        = false;
    const double start         = processor_seconds();
    SimulationResult result    = run(own, numerics, [&]() {
      if (++n_steps <= looks_at_heap || n_steps % steps_between_looks == 0)
        most_heap = std::fmax(most_heap, heap_bytes());
      is_out_of_time = now() > end;
      return !is_out_of_time && !interrupted_();
    });
    const double first_seconds = processor_seconds() - start;
    if (is_out_of_time)
      return too_long();
    if (interrupted_())
      return false;
    check_identities(result, own);
    row.status  = word_of(result.time.status);
    row.reason  = result.time.reason;
    row.message = result.time.message;
    if (!setting_.has_no_mesh())
    {
      row.steps             = result.time.steps;
      row.rejected_steps    = result.time.rejected_steps;
      row.newton_iterations = result.time.newton_iterations;
      row.most_cells        = std::max(result.most_cells, numerics.n_cells);
    }
    // A level that does not promise what was asked for has an answer all the same.
    const bool breaks_promise = row.reason == "accuracy_not_met" && std::isfinite(result.displacement);
    if (row.status != "finished" && !breaks_promise)
      return true;
    row.status = "finished";
    row.reason.clear();
    if (!breaks_promise)
      row.message.clear();
    row.displacement = result.displacement;
    row.memory       = most_heap - heap_before;
    return time_runs(row, own, numerics, first_seconds);
  }

  /// The timing; false if it was interrupted.
  bool
  TradeoffMeasurement::time_runs(TradeoffRow &row,
                                 const Parameters &own,
                                 const Numerics &numerics,
                                 const double first_seconds) const
  {
    const double n_bodies = row.setting.is_batch() ? batch_size : 1.;
    const double n_runs   = std::max(1., std::ceil(shortest_measurement / std::max(first_seconds, 1e-9)));
    std::vector<double> seconds;
    if (first_seconds > long_run)
      seconds.push_back(first_seconds / n_bodies);
    row.repetitions = static_cast<double>(seconds.size());
    // Short runs are not asked anything: that would be a part of their cost.
    const KeepGoing keep_going =
      first_seconds > long_run ? KeepGoing([this]() { return !interrupted_(); }) : KeepGoing();
    while (seconds.size() < parameters_.tradeoff.repetitions)
    {
      const double start = processor_seconds();
      double n           = 0.;
      do // the first run may have been slower than the others
      {
        run(own, numerics, keep_going);
        ++n;
      } while (n < n_runs || processor_seconds() - start < 0.5 * shortest_measurement);
      seconds.push_back((processor_seconds() - start) / (n * n_bodies));
      row.repetitions += n;
      if (interrupted_())
        return false;
    }
    std::sort(seconds.begin(), seconds.end());
    const std::size_t n = seconds.size();
    row.seconds         = 0.5 * (seconds[(n - 1) / 2] + seconds[n / 2]);
    row.spread          = (seconds.back() - seconds.front()) / row.seconds;
    return true;
  }
} // namespace crawler
