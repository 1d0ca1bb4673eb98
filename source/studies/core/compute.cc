// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/model_choice.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/base/clock.h>
#include <crawler/base/exceptions.h>
#include <crawler/run/batch.h>
#include <crawler/run/reduced_model.h>
#include <crawler/run/self_check.h>
#include <crawler/studies/core/compute.h>
#include <crawler/time/failure.h>

#include <cmath>
#include <utility>

namespace crawler
{
  namespace
  {
    RecordOptions
    options_of_batch(const Task &task)
    {
      return {.energy_balance = task.parameters.output.energy_balance,
              .gait           = task.gait ? GaitWish::declared : GaitWish::none};
    }

    /// Times a part of the work for one task. An exception becomes the status of the task, unless the user has to mend
    /// its cause; that one is stored.
    void
    guarded(Task &task, const std::function<void()> &work)
    {
      const Stopwatch clock;
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

    /// Makes scene and numerics, without which the task is stopped, or computes the result of a level that needs no
    /// numerics.
    void
    prepare(Task &task, const double time_limit, const std::function<bool()> &interrupted)
    {
      guarded(task, [&]() {
        const Stopwatch clock;
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
          task.computed.result =
            level.compute(task.parameters.accuracy, task.parameters.output.energy_balance, keep_going, task.gait);
          return;
        }
        const auto choice = choose_numerics({task.parameters, *task.scene, keep_going});
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

    /// Returns true if runs of this choice and the finer ones that measure their errors may share the lanes.
    bool
    may_share_lanes(const Task &task, const NumericsChoice &choice)
    {
      return !choice.is_of_several_runs() && batch_method(*task.scene, task.parameters.time, choice.numerics);
    }

    /// Task in the lanes, with the inputs of its run and of the finer one.
    struct Member
    {
      Task *task;
      NumericsChoice choice;
      double expected_size; ///< of the displacement, where the choice was made for other scenes; else 0 [length]
      std::optional<CycleWish> cycles;
      TimeParameters finer_time;
      Numerics finer = {}; ///< set once the run has finished

      Member(Task &its_task, const NumericsChoice &its_choice, const double its_expected_size)
        : task(&its_task)
        , choice(its_choice)
        , expected_size(its_expected_size)
        , cycles(cycle_wish(its_task.parameters, *its_task.scene, /*has_pictures=*/false))
        , finer_time(time_of_finer_run(its_task.parameters.time))
      {
      }

      bool
      has_finer_run() const
      {
        return task->parameters.error_estimate && choice.follows_rule() &&
               batch_method(*task->scene, finer_time, finer);
      }
    };

    /// Stores the answer of a member if it is as accurate as requested. Without a finer run, since no error is to be
    /// estimated, the numerics of other scenes are good for a displacement that is not smaller than expected of it.
    void
    take_answer(const Member &member, SimulationResult result, const SimulationResult *const finer)
    {
      constexpr double least_part = 0.5;
      Task &task                  = *member.task;
      NumericsChoice choice       = member.choice;
      const double size           = std::abs(result.displacement);
      if (member.expected_size > 0.)
        choice.wanted_error = task.parameters.accuracy * size;
      choice.set_size(result.displacement, task.parameters.accuracy);
      if (finer != nullptr)
        set_errors({task.parameters, *task.scene}, choice, result, finer);
      check_identities(result, task.parameters);
      const bool is_good =
        finer != nullptr ? result.error->total <= choice.wanted_error : size >= least_part * member.expected_size;
      task.has_answer = result.time.status == Status::finished && is_good;
      if (task.has_answer)
        task.computed = {std::move(result), std::move(choice)};
    }

    /**
     * Computes the runs, and the finer runs of those that finish, side by side; all have the same options. Tasks whose
     * answer is as accurate as requested have it with its errors, if these are to be estimated; other runs that
     * finished without.
     */
    void
    compute_members(std::vector<Member> members, const RecordOptions &options, const std::function<bool()> &is_in_time)
    {
      std::vector<BatchRun> runs, finer_runs;
      for (const Member &member : members)
        runs.push_back({&*member.task->scene, &member.task->parameters.time, &member.choice.numerics, member.cycles});
      auto results = run_batch(runs, options, is_in_time);
      std::vector<std::size_t> finished;
      for (std::size_t i = 0; i < members.size(); ++i)
      {
        if (!results[i])
          continue;
        Member &member        = members[i];
        const Task &task      = *member.task;
        member.finer          = numerics_of_finer_run(member.choice, task.parameters.time, *task.scene, *results[i]);
        member.task->computed = {*results[i], member.choice};
        if (results[i]->time.status != Status::finished)
          continue;
        if (!task.parameters.error_estimate)
          take_answer(member, std::move(*results[i]), nullptr);
        if (!member.has_finer_run())
          continue;
        finished.push_back(i);
        finer_runs.push_back({&*task.scene, &member.finer_time, &member.finer, member.cycles});
      }
      const auto finer_results = run_batch(finer_runs, options, is_in_time);
      for (std::size_t j = 0; j < finished.size(); ++j)
        if (finer_results[j] && finer_results[j]->time.status == Status::finished)
          take_answer(members[finished[j]], std::move(*results[finished[j]]), &*finer_results[j]);
    }

    /// Computes runs that fit the lanes, each with the numerics chosen for it.
    void
    compute_batches(const std::span<Task> tasks, const double time_limit, const std::function<bool()> &interrupted)
    {
      for (const bool energy_balance : {false, true})
      {
        std::vector<Member> members;
        for (Task &task : tasks)
          if (is_ready(task) && task.parameters.output.energy_balance == energy_balance &&
              may_share_lanes(task, task.computed.choice))
            members.emplace_back(task, task.computed.choice, /*its_expected_size=*/0.);
        if (members.empty())
          continue;
        const auto n = static_cast<double>(members.size());
        const Stopwatch clock;
        try
        {
          compute_members(members, options_of_batch(*members.front().task), [&]() {
            return clock.seconds() <= n * time_limit && !interrupted();
          });
        }
        catch (const std::exception &) // the one-by-one computation finds the faulty run
        {
        }
        for (const Member &member : members)
          member.task->seconds += clock.seconds() / n;
      }
    }

    /// Completes a task after the batch: runs, errors of the displacement, and results that follow from them.
    void
    finish(Task &task, const double time_limit, const std::function<bool()> &interrupted)
    {
      const double before = task.seconds;
      const Stopwatch clock;
      const auto keep_going = [&]() {
        task.is_out_of_time = before + clock.seconds() > time_limit;
        return !task.is_out_of_time && !interrupted();
      };
      RecordOptions options = options_of_batch(task);
      options.cycles        = cycle_wish(task.parameters, *task.scene, /*has_pictures=*/false);
      bool is_computed      = task.computed.result.time.status != Status::none;
      task.computed         = run_to_accuracy(
        {task.parameters, *task.scene, keep_going},
        task.computed.choice,
        [&](const NumericsChoice &choice) {
          return std::exchange(is_computed, false)
                           ? task.computed.result
                           : Simulation(MPI_COMM_SELF, *task.scene, task.parameters.time, choice.numerics)
                       .run({}, options, {}, keep_going);
        },
        options,
        /*writes=*/false);
    }

    bool
    may_share(const Parameters &p)
    {
      return p.model == Model::nonlinear && p.time.engine == Engine::automatic &&
             p.time.step_control == StepControl::adaptive;
    }

    void
    create_scene(Task &task)
    {
      task.scene.emplace(task.parameters.create_scene());
      choose_model(task.parameters, *task.scene); // refuses what the model cannot compute
    }

    void
    forget(Task &task)
    {
      task.computed = {};
      task.scene.reset();
      task.error = nullptr;
    }
  } // namespace

  PointStatus
  status_of(const Task &task)
  {
    if (task.error)
      try
      {
        std::rethrow_exception(task.error);
      }
      catch (const InputError &error)
      {
        return {"failed", "refused", error.what()};
      }
    if (task.is_out_of_time)
      return {
        "stopped",
        time_limit_reason,
        task.computed.result.time.status == Status::finished
          ? "it took longer than Sweep/Time limit per point while its errors were measured; the run itself is complete"
          : "it took longer than Sweep/Time limit per point"};
    const TimeOutcome &time = task.computed.result.time;
    return time.status == Status::finished ? PointStatus{word_of(time.status), "", ""}
                                           : PointStatus{word_of(time.status), time.reason, time.message};
  }

  std::string
  problem_of(const Task &task)
  {
    const auto &[status, reason, message] = status_of(task);
    return status == "finished" ? "" : reason.empty() ? status : task.error ? message : reason + ": " + message;
  }

  void
  compute_all(const std::span<Task> tasks, const double time_limit, const std::function<bool()> &interrupted)
  {
    for (Task &task : tasks)
      prepare(task, time_limit, interrupted);
    compute_batches(tasks, time_limit, interrupted);
    for (Task &task : tasks)
    {
      if (task.scene && !task.error && task.computed.result.time.status != Status::stopped &&
          !task.computed.result.error && !task.has_answer)
        guarded(task, [&]() { finish(task, time_limit, interrupted); });
      if (task.error)
        continue;
      task.computed.result.process.model = task.parameters.model;
      check_identities(task.computed.result, task.parameters);
    }
  }

  std::optional<SharedChoice>
  shared_numerics(const std::span<Task> examples, const std::function<bool()> &keep_going)
  {
    try
    {
      std::vector<Problem> problems;
      for (Task &task : examples)
      {
        if (!may_share(task.parameters))
          return std::nullopt;
        if (!task.parameters.error_estimate)
          task.parameters.accuracy *= 0.3; // no finer run finds the scenes that need more than the examples
        create_scene(task);
        problems.push_back({task.parameters, *task.scene, keep_going});
      }
      return shared_choice(problems);
    }
    catch (const std::exception &) // the one-by-one computation finds the faulty run
    {
      return std::nullopt;
    }
  }

  std::vector<bool>
  compute_similar(const std::span<Task> tasks,
                  const SharedChoice &shared,
                  const std::vector<double> &sizes,
                  const double time_limit,
                  const std::function<bool()> &interrupted)
  {
    std::vector<bool> done(tasks.size(), false);
    const Stopwatch clock;
    const auto is_in_time = [&]() { return clock.seconds() <= time_limit && !interrupted(); };
    try
    {
      std::vector<Member> members;
      for (std::size_t i = 0; i < tasks.size(); ++i)
      {
        Task &task = tasks[i];
        if (!may_share(task.parameters) ||
            task.parameters.output.energy_balance != tasks.front().parameters.output.energy_balance)
          continue;
        create_scene(task);
        if (may_share_lanes(task, shared.choice))
          members.emplace_back(task, shared.choice_for(*task.scene, sizes[i]), sizes[i]);
      }
      if (!members.empty())
        compute_members(members, options_of_batch(tasks.front()), is_in_time);
      for (std::size_t i = 0; i < tasks.size(); ++i)
        done[i] = tasks[i].has_answer;
    }
    catch (const std::exception &) // the one-by-one computation finds the faulty run
    {
      done.assign(tasks.size(), false);
    }
    for (std::size_t i = 0; i < tasks.size(); ++i)
      if (done[i])
        tasks[i].seconds = clock.seconds() / static_cast<double>(tasks.size());
      else
        forget(tasks[i]);
    return done;
  }
} // namespace crawler
