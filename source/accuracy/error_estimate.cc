// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/finer_run_errors.h>
#include <crawler/accuracy/graded_choice.h>
#include <crawler/base/communication.h>
#include <crawler/run/batch.h>
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/result_table.h>
#include <crawler/run/self_check.h>
#include <crawler/time/failure.h>

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/calibration.cc; doc/numerics.md, "Error bounds".
    constexpr double measured_factor = 1.5, factor_without_rule = 2.;
    /// Parts of the wanted error in the bound: adaptive meshes have more of their errors in common than others, and so
    /// have graded ones if kinks move through their cells; otherwise each part was measured beforehand.
    constexpr double predicted_part = 0.2, predicted_part_if_irregular = 0.5, predicted_part_if_graded = 0.15;
    /// Cells and tolerances of the finer run, relative to the run's.
    constexpr double more_cells = 1.1, finer_tolerance = 0.2, finer_mesh_tolerance = 0.1;
    /// Tolerance for runs not by radau 9, which is more accurate for the same tolerance than all others.
    constexpr double finer_tolerance_than_others = 4.;
    /// Cells and tolerance where the user chose the numerics: mesh and steps may both be the problem. As many cells
    /// where the active stress is not smooth, so that errors fall with the cells by a small power.
    constexpr double more_cells_without_rule = 2., finer_tolerance_without_rule = 0.1;
    constexpr const char *best_integrator = "radau 9";
    /// Exponent of the tolerance to which its steps are proportional; its smallest first step over the duration.
    constexpr double steps_over_tolerances = 1. / 6., first_step = 1e-3;
    /// Layers at the ends of bodies softer than soft, in natural units, about as thick as the softness; the finer run
    /// has cells as small as the softness times layer_cells there, graded by layer_ratio.
    constexpr double soft = 1e-3, layer_cells = 3., layer_ratio = 0.25, max_layer_levels = 8.;
    /// Tolerance where one cycle stands for many: its error does not average out, so the finer run is more accurate.
    constexpr double finer_tolerance_of_cycles = 0.25;
    /// Tolerance of the next try.
    constexpr double refined_tolerance = 0.1;

    /// True if the error is known beforehand: the rule of the numerics does not cover the effect of a point value of
    /// the stretch, seen from elsewhere.
    bool
    is_predicted(const NumericsChoice &choice, const Scene &scene)
    {
      return choice.follows_rule() && !scene.feels_elsewhere();
    }

    /// Changes the tolerance by @p factor. The limits of the steps change with it, as the steps of radau 9 do: steps
    /// set by the limits alone have an error, too.
    void
    change_steps(Numerics &numerics, const double factor)
    {
      numerics.tolerance *= factor;
      for (StepLimit &limit : numerics.step_limits)
        limit.longest *= std::min(1., std::pow(factor, steps_over_tolerances));
    }

    Numerics
    finer(const NumericsChoice &choice, const std::string &integrator, const Scene &scene)
    {
      Numerics n           = choice.numerics;
      const bool predicted = is_predicted(choice, scene);
      // Kinks move through cells and steps where the friction switches its direction: errors fall by low powers. A
      // displacement of 0 does not tell the error of the works. Inside soft bodies layers are as thin as at their ends.
      const bool is_soft = scene.body.elastic_modulus / natural_units(scene).force < soft;
      const bool much_finer =
        !predicted || choice.is_steep || is_soft || scene.ground.direction.is_uneven() || scene.keeps_its_centre();
      if (n.mesh.tolerance > 0.)
      {
        n.mesh.tolerance *= finer_mesh_tolerance;
        // Adaptive meshes of two tolerances may have the same cells where they matter; halved cells differ.
        if (!predicted)
          n.n_cells *= 2;
      }
      else if (n.formulation == Formulation::stretch)
        n.parts *= 2; // one family of meshes
      else
      {
        const bool many     = much_finer || choice.is_rough;
        const double factor = many ? more_cells_without_rule : more_cells;
        n.n_cells           = finer_n_cells(factor, n.n_cells, scene.breaks_in_space().size(), n.grading);
        if (many) // kinks are not at the same places of cells twice
          ++n.n_cells;
      }
      change_steps(n,
                   much_finer                      ? finer_tolerance_without_rule
                   : integrator == best_integrator ? finer_tolerance
                                                   : finer_tolerance_than_others);
      n.integrator = best_integrator;
      // Layers that neither mesh resolves would be missed by the difference.
      if (predicted && is_soft && n.mesh.tolerance == 0. && n.grading.levels == 0)
      {
        const double k      = scene.body.elastic_modulus / natural_units(scene).force;
        const double levels = std::log(layer_cells * k * n.n_cells) / std::log(layer_ratio);
        n.grading      = {static_cast<unsigned int>(std::clamp(std::ceil(levels), 1., max_layer_levels)), layer_ratio};
        n.initial_step = std::max(n.initial_step, first_step * scene.end_time);
        return n;
      }
      if (n.grading.levels > 0)
        return with_finer_grading(scene, n);
      n.initial_step = std::max(n.initial_step, first_step * scene.end_time);
      return n;
    }

    /// Sets the errors of efficiencies, which are relative to a limit by the extreme stretches.
    void
    set_errors_of_efficiencies(const Scene &scene, SimulationResult &result)
    {
      if (!result.gait_efficiency)
        return;
      const double part = error_of_efficiencies(scene, result);
      const auto stride = result.gait ? result.gait->efficiency : std::nullopt;
      for (const auto &[key, value] :
           {std::pair("gait.efficiency", result.gait_efficiency), {"gait.stride_efficiency", stride}})
        if (const auto known = error_bound(result, key); known && value)
          set_error_bound(result, key, std::max(*known, part * *value));
    }

    Simulation::Options
    options_of_finer_run(const SimulationResult &result, const std::optional<CycleWish> &cycles)
    {
      using Wish = Simulation::GaitWish;
      return {.energy_balance = result.energy_balance.has_value(),
              .cycles         = cycles,
              .gait           = !result.gait               ? Wish::none
                                : result.gait->is_declared ? Wish::declared
                                                           : Wish::any};
    }

    /// Runs with more cells and its own steps: where no rule predicts the error this separates the two parts of the
    /// error, since their sum may be small by chance.
    SimulationResult
    run_on_finer_mesh(MPI_Comm communicator,
                      const RunParameters &parameters,
                      const Scene &scene,
                      const NumericsChoice &choice,
                      const SimulationResult &result,
                      const KeepGoing &keep_going)
    {
      Numerics numerics         = choice.numerics;
      const Numerics finer_mesh = finer(choice, parameters.time.integrator, scene);
      numerics.n_cells          = finer_mesh.n_cells;
      numerics.parts            = finer_mesh.parts;
      numerics.mesh.tolerance   = finer_mesh.mesh.tolerance;
      numerics.grading          = finer_mesh.grading;
      TimeParameters time       = parameters.time;
      time.petsc_prefix         = time_of_finer_run(time).petsc_prefix;
      time.max_steps            = time_of_finer_run(time).max_steps; // the limit is for the run itself
      const auto cycles         = cycle_wish(parameters, scene, /*has_pictures=*/false);
      return Simulation(communicator, scene, time, numerics)
        .run({}, options_of_finer_run(result, cycles), {}, keep_going);
    }

    /// Result of the finer run, which may be unfinished.
    SimulationResult
    finer_run(MPI_Comm communicator,
              const RunParameters &parameters,
              const Scene &scene,
              const NumericsChoice &choice,
              const SimulationResult &result,
              const KeepGoing &keep_going)
    {
      const TimeParameters time = time_of_finer_run(parameters.time);
      const Numerics numerics   = numerics_of_finer_run(choice, parameters.time, scene, result.cycles.has_value());
      const auto cycles         = cycle_wish(parameters, scene, /*has_pictures=*/false);
      const auto options        = options_of_finer_run(result, cycles);
      // Fused engine for most runs, so that nothing else has to be built. A long one is left to a simulation, which can
      // be stopped and continued.
      constexpr double much_work = 1e8; // unknowns times steps: about a minute
      const double work          = result.mesh ? static_cast<double>(result.mesh->n_unknowns) * result.time.steps : 0.;
      if (work < much_work && size_of(communicator) == 1 && batch_method(scene, time, numerics))
      {
        const BatchRun run = {&scene, &time, &numerics};
        if (auto finer = run_batch({&run, 1}, options, keep_going, single_engine()).front())
          return std::move(*finer);
        if (!keep_going())
          return {};
      }
      return Simulation(communicator, scene, time, numerics).run({}, options, {}, keep_going);
    }
  } // namespace

  NumericsChoice
  refined(const NumericsChoice &choice, const Scene &scene, const double cells)
  {
    NumericsChoice next = choice;
    Numerics &n         = next.numerics;
    if (n.mesh.tolerance > 0.)
      n.mesh.tolerance *= refined_tolerance;
    else
      n.n_cells = finer_n_cells(cells, n.n_cells, scene.breaks_in_space().size(), n.grading);
    change_steps(n, refined_tolerance);
    if (n.grading.levels > 0)
      n = with_finer_grading(scene, n);
    return next;
  }

  TimeParameters
  time_of_finer_run(const TimeParameters &run)
  {
    TimeParameters time = run;
    time.integrator     = "automatic";
    time.engine         = Engine::automatic;
    time.step_control   = StepControl::adaptive;
    time.max_steps      = TimeParameters().max_steps; // the limit is for the run itself
    time.petsc_prefix   = "second_";                  // options after "--" are for the run itself
    return time;
  }

  Numerics
  numerics_of_finer_run(const NumericsChoice &choice,
                        const TimeParameters &time,
                        const Scene &scene,
                        const bool cycles_repeat)
  {
    Numerics numerics =
      finer(choice, time.integrator == "automatic" ? choice.numerics.integrator : time.integrator, scene);
    if (cycles_repeat)
      change_steps(numerics, finer_tolerance_of_cycles);
    return numerics;
  }

  void
  set_errors(const NumericsChoice &choice,
             SimulationResult &result,
             const SimulationResult *const finer,
             const RunParameters &parameters,
             const Scene &scene,
             const SimulationResult *const finer_mesh)
  {
    DisplacementError &error = result.error.emplace();
    double total             = choice.measured_error.value_or(choice.wanted_error);
    std::optional<double> space; // part of the total, if it was measured
    if (finer != nullptr)
    {
      if (finer->time.status != Status::finished ||
          (finer_mesh != nullptr && finer_mesh->time.status != Status::finished))
        return;
      const bool predicted = is_predicted(choice, scene);
      const bool is_graded = choice.numerics.grading.levels > 0, is_adaptive = choice.numerics.mesh.tolerance > 0.;
      const double part = !predicted                                      ? 0.
                          : is_adaptive || (is_graded && choice.is_rough) ? predicted_part_if_irregular
                          : is_graded                                     ? predicted_part_if_graded
                                                                          : predicted_part;
      const double factor =
        predicted && !choice.is_steep && !scene.keeps_its_centre() ? measured_factor : factor_without_rule;
      if (finer_mesh != nullptr)
      {
        space = factor * std::abs(finer_mesh->displacement - result.displacement);
        // Kinks that move with the place where the velocity changes its sign make errors that change their sign from
        // mesh to mesh: a difference may be small by chance, and so may be that which ended the search.
        if (scene.ground.direction.is_uneven() && choice.numerics.grading.levels > 0 && choice.follows_rule())
          space = std::max(*space, graded_change * choice.wanted_error);
        total = *space + factor * std::abs(finer->displacement - finer_mesh->displacement);
      }
      else
        total =
          factor * std::abs(finer->displacement - result.displacement) + (predicted ? part * choice.wanted_error : 0.);
      total         = std::max(total, choice.min_error);
      result.errors = number_errors(result, finer_mesh ? *finer_mesh : *finer, factor, part * parameters.accuracy);
      if (finer_mesh != nullptr)
      {
        const auto in_time = number_errors(*finer_mesh, *finer, factor, 0.);
        for (std::size_t i = 0; i < in_time.size(); ++i)
          result.errors[i] += in_time[i];
      }
      add_errors_of_cycles(
        result,
        std::max(std::abs(result.displacement),
                 std::isfinite(choice.wanted_error) ? choice.wanted_error / parameters.accuracy : 0.));
      if (scene.keeps_its_centre()) // few steps suffice except for the kinks of positive power
        set_error_bound(result, "positive_power", std::numeric_limits<double>::quiet_NaN());
      set_errors_of_efficiencies(scene, result);
    }
    if (scene.keeps_its_centre()) // round-off of each step, whatever the other errors are
    {
      total = displacement_round_off * scene.body.length * result.time.steps;
      if (std::isfinite(choice.wanted_error))
        total = std::min(total, choice.wanted_error);
    }
    if (!std::isfinite(total))
      return;
    const double cycles = result.cycles ? result.cycles->bound : 0.;
    const double rest   = std::max(total, displacement_round_off * scene.body.length);
    error.total         = rest + cycles;
    error.space         = scene.keeps_its_centre() ? 0. : space.value_or(choice.space_share * rest);
    error.time          = error.total - error.space;
    error.model         = 0.;
  }

  void
  estimate_errors(MPI_Comm communicator,
                  const RunParameters &parameters,
                  const Scene &scene,
                  const NumericsChoice &choice,
                  SimulationResult &result,
                  const KeepGoing &keep_going)
  {
    if (choice.measured_error)
      set_errors(choice, result, nullptr, parameters, scene);
    else
    {
      // Failures of the finer run do not affect the answer.
      SimulationResult finer, finer_mesh;
      const bool predicted = is_predicted(choice, scene);
      try
      {
        finer = finer_run(communicator, parameters, scene, choice, result, keep_going);
        if (!predicted && finer.time.status == Status::finished)
          finer_mesh = run_on_finer_mesh(communicator, parameters, scene, choice, result, keep_going);
      }
      catch (...)
      {
        finer.time = failure_of(std::current_exception());
        if (size_of(communicator) > 1) // the other ranks may be waiting
          throw;
      }
      set_errors(choice, result, &finer, parameters, scene, predicted ? nullptr : &finer_mesh);
    }
  }
} // namespace crawler
