// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "../support/processor_time.h"
#include "random_scenes.h"

#include <crawler/accuracy/mesh_choices.h>
#include <crawler/base/exceptions.h>
#include <crawler/studies/core/compute.h>

#include <limits>

namespace crawler::test
{
  /// No answer is waited for longer [s of processor time].
  constexpr double longest = 60., longest_second = 20.;
  /// Inversions inside agree if they are within this part of the duration.
  constexpr double same_time = 0.03;

  /// What one method says.
  struct Judgement
  {
    std::string by;
    double displacement = NAN, error = NAN;
    std::optional<double> inversion; ///< its time
    std::string problem;             ///< why it says nothing

    bool
    is_answer() const
    {
      return inversion || (std::isfinite(displacement) && std::isfinite(error));
    }
  };

  inline std::string
  reason_of(const SimulationResult &result)
  {
    return result.time.reason.empty() ? word_of(result.time.status) : result.time.reason;
  }

  /// How long a computation is waited for.
  class Patience
  {
  public:
    Patience(const unsigned long steps, const double max_seconds)
      : max_steps_(steps)
      , max_seconds_(max_seconds)
      , begin_(processor_seconds())
    {
    }

    double
    seconds() const
    {
      return processor_seconds() - begin_;
    }
    /// Called once a step.
    bool
    ends_now()
    {
      has_ended_ = has_ended_ || ++steps_ > max_steps_ || seconds() > max_seconds_;
      return has_ended_;
    }
    bool
    has_ended() const
    {
      return has_ended_;
    }

  private:
    const unsigned long max_steps_;
    const double max_seconds_, begin_;
    unsigned long steps_ = 0;
    bool has_ended_      = false;
  };

  /// What `crawler run` computes, stopped if it takes more than @p limit steps, or too long.
  inline Task
  computed(const Parameters &parameters, const unsigned long limit, const double max_seconds = longest)
  {
    Task task;
    task.parameters = parameters;
    Patience patience(limit, max_seconds);
    compute_all({&task, 1}, std::numeric_limits<double>::infinity(), [&]() { return patience.ends_now(); });
    task.seconds        = patience.seconds();
    task.is_out_of_time = patience.has_ended();
    return task;
  }

  /// The answer of the program for another form or accuracy.
  inline Judgement
  by_program(const Parameters &parameters, const std::string &name, const unsigned long limit)
  {
    const Task task                = computed(parameters, limit, longest_second);
    const SimulationResult &result = task.computed.result;
    if (task.error || task.is_out_of_time)
      return {name, NAN, NAN, {}, task.error ? "refused" : "time_limit"};
    if (result.inversion)
      return {name, NAN, NAN, result.inversion->t, ""};
    if ((result.time.status != Status::finished && result.time.reason != accuracy_not_met) || !result.error)
      return {name, NAN, NAN, {}, reason_of(result)};
    return {name, result.displacement, result.error->total, {}, ""};
  }

  /// By the position form of degree 8 through PETSc with far smaller steps, on a mesh of its own, by radau 9 and, for
  /// its error, by radau 5 on a coarser mesh; these owe nothing to the choice of the program but a number of cells that
  /// is not smaller.
  inline Judgement
  by_position_form(const Parameters &parameters,
                   const RandomScene &random,
                   const Task &own,
                   const unsigned long limit,
                   const double more = 1.)
  {
    const Scene scene      = parameters.create_scene();
    const Numerics &chosen = own.computed.choice.numerics;
    const double L = scene.body.length, T = scene.end_time;
    const bool own_is_position = chosen.n_cells > 0 && chosen.formulation == Formulation::position;
    const bool is_graded = chosen.grading.levels > 0 || !own_is_position || parameters.body.initial_stretch != "1";
    double cells         = std::max(12., 2. * L / random.length);
    if (own_is_position)
      cells = std::max(cells, 1.3 * chosen.n_cells * chosen.degree / 8.);
    cells *= more;
    const double size = std::max(std::abs(own.computed.result.displacement), 1e-4 * own.computed.result.size.largest_u);
    const double wanted =
      std::max(parameters.accuracy * (size > 0. && std::isfinite(size) ? size : 1e-3 * L), 1e-13 * L);
    Judgement judgement;
    judgement.by   = "position";
    const auto run = [&](const std::string &integrator, const double tolerance, const double part) {
      Numerics n;
      n.degree  = 8;
      n.n_cells = static_cast<unsigned int>(part * std::min(cells, 800.));
      if (is_graded)
        n.grading = {11, part < 1. ? 0.4 : 0.35};
      n.tolerance         = std::max(tolerance * wanted, 3e-15 * L);
      n.integrator        = integrator;
      n.step_limits       = {{0., random.step}};
      n.initial_step      = is_graded ? first_step_on_graded_mesh(scene, n) : 1e-3 * std::min(random.step, T / 8.);
      TimeParameters time = parameters.time;
      time.integrator     = integrator;
      time.cycle_stop     = CycleStopMode::off;
      time.engine         = Engine::petsc;
      time.max_steps      = 1000000;
      Patience patience(limit, longest_second);
      SimulationResult result;
      try
      {
        result = Simulation(MPI_COMM_SELF, scene, time, n).run({}, {}, {}, [&]() { return !patience.ends_now(); });
      }
      catch (const std::exception &error)
      {
        judgement.problem = error.what();
        return result;
      }
      if (result.time.status != Status::finished)
        judgement.problem = patience.has_ended() ? "time_limit" : reason_of(result);
      return result;
    };
    const SimulationResult fine = run("radau 9", 1e-3, 1.);
    if (fine.time.status != Status::finished && !fine.inversion)
      return judgement;
    const SimulationResult coarse = run("radau 5", 3e-2, 0.8);
    if (fine.inversion && coarse.inversion && std::abs(fine.inversion->t - coarse.inversion->t) < same_time * T)
      judgement.inversion = fine.inversion->t;
    else if (fine.time.status == Status::finished && coarse.time.status == Status::finished)
    {
      judgement.displacement = fine.displacement;
      judgement.error        = std::abs(fine.displacement - coarse.displacement) + 1e-14 * L;
    }
    return judgement;
  }
} // namespace crawler::test
