// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/pilots.h>
#include <crawler/equation/stretch_form.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    constexpr unsigned int max_pilot_steps = 100000, max_settling_steps = 20000;
    /// Relative accuracy of the displacement for pilots that end when their cycles repeat.
    constexpr double pilot_accuracy = 1e-2;
    /// First step of methods that start with their full order, relative to the duration.
    constexpr double one_step_start = 1e-2;

    // Constants measured by tests/benchmark/stretch_table.cc; doc/numerics.md, "Which form". The position form is of
    // high order where the body deforms smoothly, the stretch form of second order everywhere: so limits fall with
    // Accuracy.
    /// Limits at low accuracy, the Accuracy below which they fall, and the powers by which they do.
    constexpr double softest = 1e-3, emptied = 0.06, emptied_if_it_inverts = 3e-3, moderate = 1e-5;
    constexpr double softness_power = 0.5, stretch_power = 0.35;

    double
    falling(const double limit, const double accuracy, const double power)
    {
      return limit * std::pow(std::min(1., accuracy / moderate), power);
    }
  } // namespace

  bool
  may_be_stretch_form(const Problem &problem)
  {
    const DiscretizationParameters &own = problem.parameters.discretization;
    const TimeParameters &time          = problem.parameters.time;
    // Meshes of the stretch form are as fine as the displacement requires.
    return !problem.scene.keeps_its_centre() && own.formulation == FormulationEntry::automatic &&
           own.mesh == MeshKind::automatic && !own.degree && !own.n_cells && !time.tolerance &&
           time.step_control == StepControl::adaptive && time.engine == Engine::automatic &&
           (time.integrator == "automatic" || time.integrator.starts_with("radau")) &&
           reason_against_stretch_form(problem.scene).empty();
  }

  Pilots::Pilots(const Problem &problem)
    : Problem(problem)
    , scales(stress_scales(scene))
    , time(parameters.time)
    , cycles(cycle_wish(parameters, scene, /*has_pictures=*/false))
    , scale(scales.displacement > 0. ? std::max(scales.displacement, min_size()) : scene.body.length)
    , tolerance(std::max(1e-3 * scale, negligible_displacement()))
  {
    time.step_control = StepControl::adaptive;
    time.petsc_prefix = "pilot_";        // options after "--" are for the real run
    time.max_steps    = max_pilot_steps; // the limit is for the run itself
    if (cycles)
      cycles->accuracy = std::max(parameters.accuracy, pilot_accuracy);
  }

  SimulationResult
  Pilots::run(const Numerics &numerics, const ResolutionWish resolution)
  {
    TimeParameters own = time;
    if (must_settle)
      own.max_steps = std::min(own.max_steps, max_settling_steps);
    Simulation simulation(ranks, scene, own, numerics);
    ++n;
    SimulationResult result =
      simulation.run({}, {.energy_balance = false, .resolution = resolution, .cycles = cycles}, {}, keep_going);
    if (result.time.status == Status::stopped && result.time.reason.empty())
      throw PilotsInterrupted();
    if (must_settle && result.time.reason == "step_limit")
      throw PilotsUnsettled();
    // Displacements that are 0 whatever the numerics are tell nothing about them; the deformation at the end does,
    // while the largest one depends on where steps end.
    if (scene.keeps_its_centre())
      result.displacement = result.size.last_u;
    return result;
  }

  SimulationResult
  Pilots::run(Numerics numerics,
              const unsigned int degree,
              const unsigned int n_cells,
              const ResolutionWish resolution,
              const double part)
  {
    numerics.degree       = degree;
    numerics.n_cells      = n_cells;
    numerics.tolerance    = part * tolerance;
    numerics.initial_step = first_step(numerics);
    return run(numerics, resolution);
  }

  void
  Pilots::count(const SimulationResult &result)
  {
    last              = result;
    const double part = scene.keeps_its_centre() ? 1. : displacement_floor;
    size              = std::max(finished() ? std::abs(last.displacement) : 0., part * last.size.largest_u);
    if (size > 0.)
      size = std::max(size, min_size());
  }

  double
  Pilots::steps_to_the_end() const
  {
    const double steps = std::max(last.time.steps, 1u);
    return last.cycles ? steps * (1. + 1. * last.cycles->extrapolated / last.cycles->computed) : steps;
  }

  double
  Pilots::stiffness_over_friction() const
  {
    const double a = scene.friction_exponent();
    return stiffness(scene) / std::max(std::pow(last.stretch.min.value, a), std::pow(last.stretch.max.value, a));
  }

  bool
  Pilots::is_soft() const
  {
    const double a = scene.friction_exponent();
    return stiffness(scene) < falling(softest, parameters.accuracy, softness_power) * std::max(1., a * a);
  }

  bool
  Pilots::is_for_stretch() const
  {
    const double a = scene.friction_exponent();
    // Contracted regions slide easily for a >= 0. The stretch form has few digits; so for a smaller Accuracy only where
    // the position form cannot go on.
    return a < 0. && may_be_stretch_form(*this) && last.time.reason != "inverted_at_end" &&
           (parameters.accuracy >= 1e-7 || !finished()) &&
           last.stretch.min.value <
             falling(a > -1. ? emptied_if_it_inverts : emptied, parameters.accuracy, stretch_power);
  }

  double
  Pilots::min_size() const
  {
    const double n_cycles = cycles ? scene.end_time / cycles->period : 0.;
    return std::max(mesh_choice::min_error * scene.body.length, n_cycles * round_off_of_cycle * last.size.largest_u) /
           parameters.accuracy;
  }

  double
  Pilots::first_step(const Numerics &numerics) const
  {
    const bool is_one_step = integrator_of(parameters.time, numerics).starts_with("radau");
    return (is_one_step ? one_step_start : mesh_choice::multistep_start) * scene.end_time;
  }
} // namespace crawler
