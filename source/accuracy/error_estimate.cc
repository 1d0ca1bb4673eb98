// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/finer_run_errors.h>
#include <crawler/accuracy/mesh_choices.h>
#include <crawler/adjoint/error_sweep.h>
#include <crawler/base/communication.h>
#include <crawler/run/batch.h>
#include <crawler/run/result_table.h>
#include <crawler/run/self_check.h>
#include <crawler/time/failure.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace crawler
{
  namespace
  {
    // Constants measured by tests/verification/calibration.cc; doc/numerics.md, "Error bounds".
    constexpr double measured_factor = 1.5, factor_without_rule = 2.;
    /// Parts of the wanted error in the bound: adaptive meshes have more of their errors in common than others, and so
    /// have all if kinks move through their cells; otherwise each part was measured beforehand.
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
    /// Number of steps that hardly depends on the tolerance: the finer run has so many times as many at least.
    constexpr double few_steps = 16., more_than_few = 1.5;
    /// Layers at the ends of bodies softer than soft, in natural units, about as thick as the softness; the finer run
    /// has cells as small as the softness times layer_cells there, graded by layer_ratio.
    constexpr double soft = 1e-3, layer_cells = 3., layer_ratio = 0.25, max_layer_levels = 8.;
    /// Tolerance where one cycle stands for many: its error does not average out, so the finer run is more accurate.
    constexpr double finer_tolerance_of_cycles = 0.25;
    /// Tolerance of the mesh in the next try.
    constexpr double refined_mesh_tolerance = 0.1;

    /// Changes the tolerance by @p factor. The limits of the steps change with it, as the steps of radau 9 do: steps
    /// set by the limits alone have an error, too.
    void
    change_steps(Numerics &numerics, const double factor)
    {
      numerics.tolerance *= factor;
      for (StepLimit &limit : numerics.step_limits)
        limit.longest *= std::min(1., std::pow(factor, steps_over_tolerances));
    }

    /// Limits all steps.
    void
    limit_steps(std::vector<StepLimit> &limits, const double longest)
    {
      if (limits.empty() || limits.front().from > 0.)
        limits.insert(limits.begin(), {0., longest});
      for (StepLimit &limit : limits)
        limit.longest = std::min(limit.longest, longest);
    }

    /// Numerics with more cells, by this factor and number, or a smaller tolerance of an adaptive mesh, and smaller
    /// steps.
    Numerics
    made_finer(Numerics n,
               const Scene &scene,
               const double cells,
               const unsigned int more,
               const double mesh_tolerance,
               const double steps)
    {
      if (n.mesh.tolerance > 0.)
        n.mesh.tolerance *= mesh_tolerance;
      else if (n.formulation == Formulation::stretch)
        n.parts *= 2; // one family of meshes
      else
        n.n_cells = finer_n_cells(cells, n.n_cells, scene.breaks_in_space().size(), n.grading) + more;
      change_steps(n, steps);
      return n.grading.levels > 0 ? with_finer_grading(scene, n) : n;
    }

    RecordOptions
    options_of_finer_run(const Problem &problem, const SimulationResult &result)
    {
      return {.energy_balance = result.energy_balance.has_value(),
              .cycles         = cycle_wish(problem.parameters, problem.scene, /*has_pictures=*/false),
              .gait           = !result.gait               ? GaitWish::none
                                : result.gait->is_declared ? GaitWish::declared
                                                           : GaitWish::any};
    }

    /// Runs with more cells and its own steps: where no rule predicts the error this separates the two parts of the
    /// error, since their sum may be small by chance.
    SimulationResult
    run_on_finer_mesh(const Problem &problem, const NumericsChoice &choice, const SimulationResult &result)
    {
      const auto &[parameters, scene, keep_going, ranks] = problem;
      Numerics numerics                                  = choice.numerics;
      const Numerics finer_mesh = numerics_of_finer_run(choice, parameters.time, scene, result);
      numerics.n_cells          = finer_mesh.n_cells;
      numerics.parts            = finer_mesh.parts;
      numerics.mesh.tolerance   = finer_mesh.mesh.tolerance;
      numerics.grading          = finer_mesh.grading;
      TimeParameters time       = parameters.time;
      time.petsc_prefix         = time_of_finer_run(time).petsc_prefix;
      time.max_steps            = time_of_finer_run(time).max_steps; // the limit is for the run itself
      return Simulation(ranks, scene, time, numerics).run({}, options_of_finer_run(problem, result), {}, keep_going);
    }

    /// Result of the finer run, which may be unfinished.
    SimulationResult
    finer_run(const Problem &problem, const NumericsChoice &choice, const SimulationResult &result)
    {
      const auto &[parameters, scene, keep_going, ranks] = problem;
      const TimeParameters time                          = time_of_finer_run(parameters.time);
      const Numerics numerics = numerics_of_finer_run(choice, parameters.time, scene, result);
      const auto options      = options_of_finer_run(problem, result);
      // Fused engine for most runs, so that nothing else has to be built. A long one is left to a simulation, which can
      // be stopped and continued.
      constexpr double much_work = 1e8; // unknowns times steps: about a minute
      const double work          = static_cast<double>(result.process.mesh.n_unknowns) * result.time.steps;
      if (work < much_work && size_of(ranks) == 1 && batch_method(scene, time, numerics))
      {
        const BatchRun run = {&scene, &time, &numerics};
        if (auto finer = run_batch({&run, 1}, options, keep_going, single_engine()).front())
          return std::move(*finer);
        if (!keep_going())
          return {};
      }
      return Simulation(ranks, scene, time, numerics).run({}, options, {}, keep_going);
    }
  } // namespace

  NumericsChoice
  refined(const NumericsChoice &choice, const Scene &scene, const double cells, const double tolerance)
  {
    NumericsChoice next = choice;
    next.numerics       = made_finer(choice.numerics, scene, cells, /*more=*/0, refined_mesh_tolerance, tolerance);
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
                        const SimulationResult &result)
  {
    const bool predicted = choice.follows_rule(), is_adaptive = choice.numerics.mesh.tolerance > 0.;
    const bool is_by_best = integrator_of(time, choice.numerics) == best_integrator;
    // Kinks move through cells and steps where the friction switches its direction: errors fall by low powers. A
    // displacement of 0 does not tell the error of the works. Inside soft bodies layers are as thin as at their ends.
    const double k     = stiffness(scene);
    const bool is_soft = k < soft;
    const bool much_finer =
      !predicted || choice.is_steep || is_soft || scene.ground.direction.is_uneven() || scene.keeps_its_centre();
    const bool many = much_finer || choice.is_rough;
    Numerics n      = made_finer(choice.numerics,
                            scene,
                            many ? more_cells_without_rule : more_cells,
                            /*more=*/many ? 1 : 0, // kinks are not at the same places of cells twice
                            finer_mesh_tolerance,
                            much_finer   ? finer_tolerance_without_rule
                                 : is_by_best ? finer_tolerance
                                              : finer_tolerance_than_others);
    n.integrator    = best_integrator;
    // Adaptive meshes of two tolerances may have the same cells where they matter; halved cells differ.
    if (is_adaptive && !predicted)
      n.n_cells *= 2;
    if (is_adaptive && scene.feels_elsewhere()) // the mesh does not follow the effect of places that are seen
    {
      n.mesh.tolerance = 0.;
      n.n_cells        = static_cast<unsigned int>(more_cells_without_rule) * result.process.mesh.most_cells + 1;
    }
    if (n.grading.levels == 0)
      n.initial_step = std::max(n.initial_step, first_step * scene.end_time);
    // Layers that neither mesh resolves would be missed by the difference.
    if (predicted && is_soft && !is_adaptive && n.grading.levels == 0)
    {
      const double levels = std::log(layer_cells * k * n.n_cells) / std::log(layer_ratio);
      n.grading = {static_cast<unsigned int>(std::clamp(std::ceil(levels), 1., max_layer_levels)), layer_ratio};
    }
    if (result.cycles)
      change_steps(n, finer_tolerance_of_cycles);
    if (result.time.status == Status::finished && result.time.steps <= few_steps)
    {
      const double covered =
        scene.end_time - (result.cycles ? result.cycles->extrapolated * result.cycles->period : 0.);
      limit_steps(n.step_limits, covered / (more_than_few * result.time.steps));
    }
    return n;
  }

  void
  set_errors(const Problem &problem,
             const NumericsChoice &choice,
             SimulationResult &result,
             const SimulationResult *const finer,
             const SimulationResult *const finer_mesh)
  {
    const double accuracy    = problem.parameters.accuracy;
    const Scene &scene       = problem.scene;
    DisplacementError &error = result.error.emplace();
    double total             = choice.measured_error.value_or(choice.wanted_error);
    std::optional<double> space; // part of the total, if it was measured
    if (finer != nullptr)
    {
      if (finer->time.status != Status::finished ||
          (finer_mesh != nullptr && finer_mesh->time.status != Status::finished))
        return;
      const bool predicted = choice.follows_rule();
      const bool is_graded = choice.numerics.grading.levels > 0, is_adaptive = choice.numerics.mesh.tolerance > 0.;
      const double part = !predicted                       ? 0.
                          : is_adaptive || choice.is_rough ? predicted_part_if_irregular
                          : is_graded                      ? predicted_part_if_graded
                                                           : predicted_part;
      const double factor =
        predicted && !choice.is_steep && !scene.keeps_its_centre() ? measured_factor : factor_without_rule;
      if (finer_mesh != nullptr)
      {
        space = factor * std::abs(finer_mesh->displacement - result.displacement);
        total = *space + factor * std::abs(finer->displacement - finer_mesh->displacement);
      }
      else
        total =
          factor * std::abs(finer->displacement - result.displacement) + (predicted ? part * choice.wanted_error : 0.);
      total         = std::max(total, choice.min_error);
      result.errors = number_errors(result, finer_mesh ? *finer_mesh : *finer, factor, part * accuracy);
      if (finer_mesh != nullptr)
      {
        const auto in_time = number_errors(*finer_mesh, *finer, factor, 0.);
        for (std::size_t i = 0; i < in_time.size(); ++i)
          result.errors[i] += in_time[i];
      }
      add_errors_of_cycles(result,
                           std::max(std::abs(result.displacement),
                                    std::isfinite(choice.wanted_error) ? choice.wanted_error / accuracy : 0.));
      if (scene.keeps_its_centre()) // few steps suffice except for the kinks of positive power
        set_error_bound(result, "positive_power", std::numeric_limits<double>::quiet_NaN());
    }
    if (scene.keeps_its_centre()) // round-off of each step, whatever the other errors are
    {
      total = displacement_round_off * scene.body.length * result.time.steps;
      if (std::isfinite(choice.wanted_error))
        total = std::min(total, choice.wanted_error);
    }
    if (std::isfinite(total))
    {
      const double cycles = result.cycles ? result.cycles->bound : 0.;
      const double rest   = std::max(total, displacement_round_off * scene.body.length);
      error.total         = rest + cycles;
      error.space         = scene.keeps_its_centre() ? 0. : space.value_or(choice.space_share * rest);
      error.time          = error.total - error.space;
      error.model         = 0.;
    }
    extend_errors(scene, result);
  }

  void
  estimate_errors(const Problem &problem, const NumericsChoice &choice, SimulationResult &result)
  {
    if (choice.measured_error)
    {
      set_errors(problem, choice, result, nullptr);
      return;
    }
    // Failures of the finer run do not affect the answer.
    SimulationResult finer, finer_mesh;
    const bool predicted = choice.follows_rule();
    try
    {
      finer = finer_run(problem, choice, result);
      if (!predicted && finer.time.status == Status::finished)
        finer_mesh = run_on_finer_mesh(problem, choice, result);
    }
    catch (...)
    {
      finer.time = failure_of(std::current_exception());
      if (size_of(problem.ranks) > 1) // the other ranks may be waiting
        throw;
    }
    set_errors(problem, choice, result, &finer, predicted ? nullptr : &finer_mesh);
  }

  bool
  sweep_error(const Problem &problem, const NumericsChoice &choice, SimulationResult &result)
  {
    const auto &[parameters, scene, keep_going, ranks] = problem;
    constexpr double max_work                          = 5e4; // steps times cells: about a second
    if (result.time.status != Status::finished || !result.error || !std::isfinite(result.error->total) ||
        result.cycles || size_of(ranks) > 1 ||
        scene.ground.direction.is_uneven() || // moving kinks have no higher orders
        !RecordedRun::is_possible(scene, parameters.time, choice.numerics) ||
        static_cast<double>(result.time.steps) * result.process.mesh.most_cells > max_work)
      return false;
    DisplacementError &error = *result.error;
    const double known       = error.total;
    try
    {
      const RecordedRun run(scene, parameters.time, choice.numerics, keep_going); // without the journal
      const auto swept = sweep_errors(run);
      if (!swept || !swept->is_good())
        return false;
      const double value = run.displacement + swept->time + swept->space;
      const double bound = std::max(swept->bound_of_corrected(), displacement_round_off * scene.body.length);
      const double found = std::abs(result.displacement - value);
      if (bound < found) // otherwise it may be the sweep's own error
        error.total = std::max(error.total, found + bound);
      extend_errors(scene, result);
      if (bound < error.total)
        result.corrected = {value, bound};
      const double all = swept->time_sum + swept->space_sum;
      if (all > 0.)
      {
        error.space = error.total * swept->space_sum / all;
        error.time  = error.total - error.space;
      }
    }
    catch (const std::runtime_error &) // the bound stays; if the sweep was stopped the error is unknown
    {
      if (!keep_going())
        error = DisplacementError();
    }
    return error.total > known;
  }
} // namespace crawler
