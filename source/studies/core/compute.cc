// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/model_choice.h>
#include <crawler/accuracy/run_as_promised.h>
#include <crawler/accuracy/stress_scales.h>
#include <crawler/run/batch.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/core/study.h>
#include <crawler/time/failure.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace crawler
{
  namespace
  {
    Simulation::Options
    options_of(const Parameters &parameters, const Scene &scene, const Simulation::GaitWish gait)
    {
      return {.energy_balance = parameters.output.energy_balance,
              .cycles         = cycle_wish(parameters, scene, /*has_pictures=*/false),
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
          task.computed.result.time.status = Status::stopped;
      });
    }

    bool
    is_ready(const Task &task)
    {
      return !task.error && task.computed.result.time.status == Status::none;
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
                                          cycle_wish(task.parameters, *task.scene, /*has_pictures=*/false)});
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
      bool is_computed = task.computed.result.time.status != Status::none;
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
      if (task.scene && !task.error && task.computed.result.time.status != Status::stopped &&
          !task.computed.result.error)
        guarded(task, [&]() { finish(task, time_limit, interrupted); });
      if (!task.error)
        check_identities(task.computed.result, task.parameters);
    }
  }

  namespace
  {
    /// So few are not worth three choices of the numerics.
    constexpr std::size_t fewest = 6;

    /// What an answer of the shared numerics needs: a bar that can be compared with what is wanted.
    bool
    may_share(const Parameters &p)
    {
      return p.model == Model::nonlinear && p.error_estimate && p.time.engine == Engine::automatic &&
             p.time.step_control == StepControl::adaptive;
    }

    /// The choice for one scene, if it is one that others can share.
    std::optional<NumericsChoice>
    choose(const Task &task, const std::function<bool()> &keep_going)
    {
      const auto choice = choose_numerics(MPI_COMM_SELF, task.parameters, *task.scene, keep_going);
      if (!choice || choice->is_measured || choice->is_family || !std::isfinite(choice->promised_error) ||
          !batch_method(*task.scene, task.parameters.time, choice->numerics))
        return std::nullopt;
      return choice;
    }

    /// The finest of the choices for the first, the middle and the last of the scenes; nothing if they are of different
    /// kinds.
    std::optional<NumericsChoice>
    shared_choice(const std::span<Task> tasks, const std::function<bool()> &keep_going)
    {
      std::optional<NumericsChoice> finest;
      for (const std::size_t anchor : {std::size_t(0), tasks.size() / 2, tasks.size() - 1})
      {
        const auto choice = choose(tasks[anchor], keep_going);
        if (!choice || (finest && choice->numerics.integrator != finest->numerics.integrator))
          return std::nullopt;
        if (!finest)
        {
          finest = choice;
          continue;
        }
        const Numerics a = finest->numerics, &b = choice->numerics;
        Numerics &n    = finest->numerics;
        n              = b.n_cells * b.degree > a.n_cells * a.degree ? b : a;
        n.tolerance    = std::min(a.tolerance, b.tolerance);
        n.initial_step = std::min(a.initial_step, b.initial_step);
        n.least_event  = std::min(a.least_event, b.least_event);
      }
      return finest;
    }

    /// Leaves nothing of a try behind.
    void
    forget(Task &task)
    {
      task.computed = {};
      task.scene.reset();
      task.error   = nullptr;
      task.seconds = 0.;
    }

    /// A task that shares the numerics, and what its run and the finer one take.
    struct Member
    {
      Task *task;
      NumericsChoice own;
      std::optional<CycleWish> cycles;
      Numerics finer; ///< once the run has finished
      TimeParameters finer_time;
    };

    std::vector<Member>
    members_of(const std::span<Task> tasks, const std::vector<bool> &wanted, const NumericsChoice &shared)
    {
      std::vector<Member> members;
      for (std::size_t i = 0; i < tasks.size(); ++i)
      {
        const Parameters &parameters = tasks[i].parameters;
        const Scene &scene           = *tasks[i].scene;
        if (!wanted[i] || !batch_method(scene, parameters.time, shared.numerics))
          continue;
        // Each stress has events of its own.
        NumericsChoice own = shared;
        own.numerics.step_limits =
          similar_step_limits(scene, own.numerics.step_limits, own.numerics.least_event / least_event);
        members.push_back({&tasks[i],
                           own,
                           cycle_wish(parameters, scene, /*has_pictures=*/false),
                           {},
                           time_of_finer_run(parameters.time)});
      }
      return members;
    }

    /// The runs, and of those that finish the finer ones. Tasks whose answer is as good as it should be have it.
    void
    compute_members(std::vector<Member> members,
                    const Simulation::Options &options,
                    const std::function<bool()> &is_in_time)
    {
      std::vector<BatchRun> runs, finer_runs;
      for (const Member &member : members)
        runs.push_back({&*member.task->scene, &member.task->parameters.time, &member.own.numerics, member.cycles});
      auto results = run_batch(runs, options, is_in_time);
      std::vector<std::size_t> finished;
      for (std::size_t i = 0; i < members.size(); ++i)
      {
        if (!results[i] || results[i]->time.status != Status::finished)
          continue;
        Member &member     = members[i];
        const Task &task   = *member.task;
        const bool repeats = results[i]->cycles.has_value();
        member.finer       = numerics_of_finer_run(member.own, task.parameters.time, *task.scene, repeats);
        if (!batch_method(*task.scene, member.finer_time, member.finer))
          continue;
        finished.push_back(i);
        finer_runs.push_back({&*task.scene, &member.finer_time, &member.finer, member.cycles});
      }
      const auto finer_results = run_batch(finer_runs, options, is_in_time);
      for (std::size_t j = 0; j < finished.size(); ++j)
      {
        if (!finer_results[j] || finer_results[j]->time.status != Status::finished)
          continue;
        const Member &member     = members[finished[j]];
        Task &task               = *member.task;
        SimulationResult &result = *results[finished[j]];
        NumericsChoice choice    = member.own;
        choice.wanted_error      = task.parameters.accuracy * std::abs(result.displacement);
        choice.promised_error    = choice.wanted_error;
        set_errors(choice, result, &*finer_results[j], task.parameters, *task.scene);
        check_identities(result, task.parameters);
        if (result.time.status == Status::finished && result.error->total <= choice.wanted_error)
          task.computed = {std::move(result), choice};
      }
    }
  } // namespace

  std::vector<bool>
  compute_similar(const std::span<Task> tasks,
                  const std::vector<bool> &wanted,
                  const double time_limit,
                  const std::function<bool()> &interrupted)
  {
    std::vector<bool> done(tasks.size(), false);
    const double start    = now();
    const auto n_wanted   = std::count(wanted.begin(), wanted.end(), true);
    const auto is_in_time = [&]() { return now() - start <= time_limit && !interrupted(); };
    if (tasks.size() < fewest || n_wanted == 0 ||
        !std::all_of(tasks.begin(), tasks.end(), [](const Task &task) { return may_share(task.parameters); }))
      return done;
    try
    {
      for (Task &task : tasks)
      {
        task.scene.emplace(task.parameters.create_scene());
        choose_model(task.parameters, *task.scene); // refuses what the model cannot compute
      }
      if (const auto shared = shared_choice(tasks, is_in_time))
        compute_members(
          members_of(tasks, wanted, *shared),
          {.energy_balance = tasks.front().parameters.output.energy_balance, .gait = gait_wish(tasks.front())},
          is_in_time);
      for (std::size_t i = 0; i < tasks.size(); ++i)
        done[i] = tasks[i].computed.result.time.status != Status::none;
    }
    catch (const std::exception &) // whoever computes them one by one finds out what is wrong with which
    {
      done.assign(tasks.size(), false);
    }
    const double seconds = (now() - start) / static_cast<double>(n_wanted);
    for (std::size_t i = 0; i < tasks.size(); ++i)
      if (done[i])
        tasks[i].seconds = seconds;
      else
        forget(tasks[i]);
    return done;
  }
} // namespace crawler
