// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/model_choice.h>
#include <crawler/accuracy/stress_scales.h>
#include <crawler/run/batch.h>
#include <crawler/run/self_check.h>
#include <crawler/studies/core/compute_similar.h>
#include <crawler/studies/core/study.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// So few are not worth three choices of the numerics.
    constexpr std::size_t fewest = 6;

    /// What an answer of the shared numerics needs: a bar that can be compared with what is wanted.
    bool
    may_share(const Parameters &p)
    {
      return p.model == "nonlinear" && p.error_estimate && p.time.engine == "automatic" &&
             p.time.step_control == "adaptive";
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
        Numerics &n       = finest->numerics;
        const auto &other = choice->numerics;
        if (other.n_cells * other.degree > n.n_cells * n.degree)
        {
          const Numerics coarser = n;
          n                      = other;
          n.tolerance            = std::min(coarser.tolerance, other.tolerance);
          n.initial_step         = std::min(coarser.initial_step, other.initial_step);
          n.least_event          = std::min(coarser.least_event, other.least_event);
        }
        else
        {
          n.tolerance    = std::min(n.tolerance, other.tolerance);
          n.initial_step = std::min(n.initial_step, other.initial_step);
          n.least_event  = std::min(n.least_event, other.least_event);
        }
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
  } // namespace

  std::vector<bool>
  compute_similar(const std::span<Task> tasks,
                  const std::vector<bool> &wanted,
                  const double time_limit,
                  const std::function<bool()> &interrupted)
  {
    const std::vector<bool> none(tasks.size(), false);
    const double start    = now();
    const auto n_wanted   = std::count(wanted.begin(), wanted.end(), true);
    const auto is_in_time = [&]() { return now() - start <= time_limit && !interrupted(); };
    if (tasks.size() < fewest || n_wanted == 0 ||
        !std::all_of(tasks.begin(), tasks.end(), [](const Task &task) { return may_share(task.parameters); }))
      return none;
    std::vector<bool> done = none;
    try
    {
      for (Task &task : tasks)
      {
        task.scene.emplace(task.parameters.create_scene());
        choose_model(task.parameters, *task.scene); // refuses what the model cannot compute
      }
      const auto shared = shared_choice(tasks, is_in_time);
      if (!shared)
      {
        for (Task &task : tasks)
          forget(task);
        return none;
      }

      // The runs, without and with energy balance, and of those that finish the finer ones.
      struct Member
      {
        std::size_t task;
        NumericsChoice own;
        std::optional<CycleWish> cycles;
        Numerics finer;
        TimeParameters finer_time;
      };
      std::vector<Member> members;
      for (std::size_t i = 0; i < tasks.size(); ++i)
        if (wanted[i] && batch_method(*tasks[i].scene, tasks[i].parameters.time, shared->numerics))
        {
          // Each stress has events of its own.
          NumericsChoice own = *shared;
          own.numerics.step_limits =
            similar_step_limits(*tasks[i].scene, own.numerics.step_limits, own.numerics.least_event / least_event);
          members.push_back({i,
                             own,
                             cycle_wish(tasks[i].parameters, *tasks[i].scene, 0),
                             {},
                             time_of_finer_run(tasks[i].parameters.time)});
        }
      std::vector<BatchRun> runs;
      for (const Member &member : members)
        runs.push_back(
          {&*tasks[member.task].scene, &tasks[member.task].parameters.time, &member.own.numerics, member.cycles});
      const Simulation::Options options = {.energy_balance = tasks.front().parameters.output.energy_balance,
                                           .gait           = tasks.front().gait ? Simulation::GaitWish::declared
                                                                                : Simulation::GaitWish::none};
      auto results                      = run_batch(runs, options, is_in_time);
      std::vector<std::size_t> finished;
      std::vector<BatchRun> finer_runs;
      for (std::size_t i = 0; i < members.size(); ++i)
      {
        if (!results[i] || results[i]->time.status != "finished")
          continue;
        Member &member     = members[i];
        const Task &task   = tasks[member.task];
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
        const std::size_t i = finished[j];
        Task &task          = tasks[members[i].task];
        if (!finer_results[j] || finer_results[j]->time.status != "finished")
          continue;
        SimulationResult &result = *results[i];
        NumericsChoice choice    = members[i].own;
        choice.wanted_error      = task.parameters.accuracy * std::abs(result.displacement);
        choice.promised_error    = choice.wanted_error;
        set_errors(choice, result, &*finer_results[j], task.parameters, *task.scene);
        check_identities(result, task.parameters);
        if (result.time.status != "finished" || !(result.error->total <= choice.wanted_error))
          continue;
        task.computed         = {std::move(result), choice};
        done[members[i].task] = true;
      }
      const double seconds = (now() - start) / static_cast<double>(n_wanted);
      for (std::size_t i = 0; i < tasks.size(); ++i)
        if (done[i])
          tasks[i].seconds = seconds;
        else
          forget(tasks[i]);
      return done;
    }
    catch (const std::exception &) // whoever computes them one by one finds out what is wrong with which
    {
      for (Task &task : tasks)
        forget(task);
      return none;
    }
  }
} // namespace crawler
