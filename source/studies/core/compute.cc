// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/model_choice.h>
#include <crawler/accuracy/run_as_promised.h>
#include <crawler/run/batch.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/studies/core/compute.h>
#include <crawler/time/failure.h>

#include <chrono>
#include <utility>

namespace crawler
{
  namespace
  {
    Simulation::Options
    options_of(const Parameters &parameters, const Scene &scene, const Simulation::GaitWish gait)
    {
      return {.energy_balance = parameters.output.energy_balance,
              .resolution     = false,
              .cycles         = cycle_wish(parameters, scene, 0),
              .gait           = gait};
    }

    SimulationResult
    simulate(const Parameters &parameters,
             const Scene &scene,
             const Numerics &numerics,
             const Simulation::GaitWish gait,
             const std::function<bool()> &keep_going)
    {
      Simulation simulation(MPI_COMM_SELF, scene, parameters.time, numerics);
      return simulation.run({}, options_of(parameters, scene, gait), {}, keep_going);
    }

    Simulation::GaitWish
    gait_wish(const Task &task)
    {
      return task.gait ? Simulation::GaitWish::declared : Simulation::GaitWish::none;
    }

    class Clock
    {
    public:
      double
      seconds() const
      {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
      }

    private:
      const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
    };

    /// A part of the work for one task: its time is taken. What it throws is how the task ended, unless the user has to
    /// mend it; that is kept.
    void
    guarded(Task &task, const std::function<void()> &work)
    {
      const Clock clock;
      try
      {
        work();
      }
      catch (...)
      {
        try
        {
          const TimeOutcome failure = failure_of(std::current_exception());
          task.computed.result      = {};
          task.computed.result.time = failure;
        }
        catch (...)
        {
          task.error = std::current_exception();
        }
      }
      task.seconds += clock.seconds();
    }

    /// Scene and numerics, without which the task is stopped; or the result of a level that needs none.
    void
    prepare(Task &task, const double time_limit, const std::function<bool()> &interrupted)
    {
      guarded(task, [&]() {
        const Clock clock;
        task.scene.emplace(task.parameters.create_scene());
        const auto keep_going = [&]() {
          task.is_out_of_time = clock.seconds() > time_limit;
          return !task.is_out_of_time && !interrupted();
        };
        const ModelChoice model = choose_model(task.parameters, *task.scene);
        task.parameters.model   = model.model;
        if (!model.needs_mesh())
        {
          ReducedModel level(*task.scene, model.model);
          SimulationResult &result = task.computed.result;
          result = level.compute(task.parameters.accuracy, task.parameters.output.energy_balance, keep_going);
          if (task.gait)
            level.describe_gait(result);
          return;
        }
        const auto choice = choose_numerics(MPI_COMM_SELF, task.parameters, *task.scene, keep_going);
        if (choice)
          task.computed.choice = *choice;
        else
          task.computed.result.time.status = "stopped";
      });
    }

    bool
    is_ready(const Task &task)
    {
      return !task.error && task.computed.result.time.status.empty();
    }

    /// Runs that fit, side by side.
    void
    compute_batches(const std::span<Task> tasks, const double time_limit, const std::function<bool()> &interrupted)
    {
      std::vector<BatchRun> runs[2]; // without and with energy balance
      std::vector<Task *> members[2];
      for (Task &task : tasks)
        if (is_ready(task) && !task.computed.choice.is_family &&
            batch_method(*task.scene, task.parameters.time, task.computed.choice.numerics))
        {
          const bool energy_balance = task.parameters.output.energy_balance;
          runs[energy_balance].push_back({&*task.scene,
                                          &task.parameters.time,
                                          &task.computed.choice.numerics,
                                          cycle_wish(task.parameters, *task.scene, 0)});
          members[energy_balance].push_back(&task);
        }
      for (const bool energy_balance : {false, true})
      {
        const double n = static_cast<double>(runs[energy_balance].size());
        const Clock clock;
        std::vector<std::optional<SimulationResult>> results;
        try
        {
          results = run_batch(runs[energy_balance],
                              {.energy_balance = energy_balance, .gait = gait_wish(tasks.front())},
                              [&]() { return clock.seconds() <= n * time_limit && !interrupted(); });
        }
        catch (const std::exception &) // whoever computes them one by one finds out what is wrong with which
        {
        }
        for (std::size_t i = 0; i < results.size(); ++i)
        {
          members[energy_balance][i]->seconds += clock.seconds() / n;
          if (results[i])
            members[energy_balance][i]->computed.result = std::move(*results[i]);
        }
      }
    }
    /// What the batch has left: runs, and errors of the displacement with what follows from them.
    void
    finish(Task &task, const double time_limit, const std::function<bool()> &interrupted)
    {
      const double before = task.seconds;
      const Clock clock;
      const auto keep_going = [&]() {
        task.is_out_of_time = before + clock.seconds() > time_limit;
        return !task.is_out_of_time && !interrupted();
      };
      bool is_computed = !task.computed.result.time.status.empty();
      Answer answer    = run_as_promised(
        MPI_COMM_SELF,
        task.parameters,
        *task.scene,
        task.computed.choice,
        [&](const NumericsChoice &choice) {
          return std::exchange(is_computed, false)
                      ? task.computed.result
                      : simulate(task.parameters, *task.scene, choice.numerics, gait_wish(task), keep_going);
        },
        options_of(task.parameters, *task.scene, gait_wish(task)),
        /*writes=*/false,
        keep_going);
      task.computed = {std::move(answer.result), std::move(answer.choice)};
    }
  } // namespace

  void
  compute_all(const std::span<Task> tasks, const double time_limit, const std::function<bool()> &interrupted)
  {
    for (Task &task : tasks)
      prepare(task, time_limit, interrupted);
    compute_batches(tasks, time_limit, interrupted);
    for (Task &task : tasks)
    {
      if (task.scene && !task.error && task.computed.result.time.status != "stopped" && !task.computed.result.error)
        guarded(task, [&]() { finish(task, time_limit, interrupted); });
      if (!task.error)
        check_identities(task.computed.result, task.parameters);
    }
  }
} // namespace crawler
