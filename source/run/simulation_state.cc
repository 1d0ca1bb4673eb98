// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Part of Simulation that examines accepted states, decides whether they may be used, and integrates over them
// (doc/numerics.md, "Energy balance and self-checks").
#include <crawler/run/simulation.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace crawler
{
  namespace
  {
    /// Number of successive steps smaller than tiny_step, as a part of the duration, that are a failure.
    constexpr double tiny_step            = 1e-9;
    constexpr unsigned int max_tiny_steps = 2000;
    /// Number of them at a stretch below nearly_zero that means that it is lost: the rest of it is the error of
    /// Newton's method.
    constexpr unsigned int max_steps_at_zero = 20;
    constexpr double nearly_zero             = 1e-6;
  } // namespace

  /// Examines a state that the time stepper has accepted; returns why the run ends if it must not be used.
  Simulation::Ending
  Simulation::examine(const Step &step, const std::span<const double> y)
  {
    if (stress_failed())
      return Ending::lost;
    const bool lane_samples = run_->observers.empty() && samples_lanes(step);
    StretchRange &stretch = run_->state.stretch = lane_samples ? stretch_of_lanes() : mesh_.assembler->stretch_range(y);
    if (!std::isfinite(stretch.min.value) || !std::isfinite(stretch.max.value))
    {
      run_->diagnosis = {Status::failed,
                         "nonfinite",
                         fmt::format("the stretch at s = {:.6g}, t = {:.6g} is not a finite number",
                                     stretch.min.s * units_.length,
                                     step.time * units_.time)};
      return Ending::lost;
    }
    if (end_inverts(step.time - step.size, step.time))
      return Ending::lost;
    // Events of the active stress within the step that its ends do not show: it is repeated with shorter steps.
    if (run_->limiter.passed_over_event(step.time - step.size, step.time))
      return Ending::retry;
    if (stretch.min.value <= lost_stretch())
    {
      // Meshes that are too coarse can lose it, too, so the mesh is refined first.
      if (is_adaptive() && mesh_.velocity->compute(step.time, step.size, y, v_) && !mesh_is_good(step, y))
        return Ending::mesh;
      locate_inversion(step);
      return Ending::lost;
    }
    // Pictures need the velocity at output times only, the energy balance and adaptive meshes always.
    const bool is_shown = !run_->observers.empty() && run_->output_times.next() <= step.time + min_time_between_breaks;
    if ((run_->options.energy_balance || is_adaptive() || is_shown) && !lane_samples &&
        !finds_velocity(step.time, step.size, y, v_))
      return Ending::lost;
    if (is_adaptive() && !mesh_is_good(step, y))
      return Ending::mesh;
    if (lane_samples)
      sample_lanes(step);
    else
    {
      if (!compute_integrals(step, y))
        return Ending::lost;
      if (samples_lanes(step))
        see_stretch_of_lanes(integrators_.lanes->tables().setup.n_stages - 1);
      else
        run_->recorder.see_stretch({stretch.min.value, stretch.min.s, step.time},
                                   {stretch.max.value, stretch.max.s, step.time});
    }
    if (run_->options.resolution != ResolutionWish::none)
      look_at_resolution(step, y);
    if (stagnates(step))
      return Ending::lost;
    keep_history(step, y);
    run_->accepted.y.assign(y.begin(), y.end());
    run_->accepted.time     = step.time;
    run_->accepted.is_there = true;
    return Ending::none;
  }

  /// Finds the velocity of a state, or sets the diagnosis why there is none.
  bool
  Simulation::finds_velocity(const double t, const double size, const std::span<const double> y, std::vector<double> &v)
  {
    if (mesh_.velocity->compute(t, size, y, v))
      return true;
    explain_no_velocity(t);
    return false;
  }

  void
  Simulation::explain_no_velocity(const double t)
  {
    if (!law_failed() && !stress_failed())
      run_->diagnosis = {
        Status::failed,
        "linear_failed",
        fmt::format("the velocity at t = {:.6g} cannot be computed: the friction matrix is singular", t * units_.time)};
  }

  void
  Simulation::look_at_resolution(const Step &step, const std::span<const double> y)
  {
    SolutionSize &size = result().size;
    size.last_u        = mesh_.assembler->root_mean_square(y);
    size.largest_u     = std::max(size.largest_u, size.last_u);
    if (mesh_.stretch != nullptr || run_->options.resolution != ResolutionWish::all)
      return;
    if (!is_adaptive() && mesh_.velocity->compute(step.time, step.size, y, v_))
    {
      const auto indicators = mesh_.discretization->gather(mesh_.position->error_indicators(step.time, y, v_));
      size.largest_indicator =
        std::max(size.largest_indicator, std::accumulate(indicators.begin(), indicators.end(), 0.));
    }
    const Resolution now = mesh_.position->resolution(y);
    size.highest_mode    = std::max(size.highest_mode, now.highest_mode);
    size.strain          = std::max(size.strain, now.strain);
  }

  /// True if there are too many small steps; sets the diagnosis then.
  bool
  Simulation::stagnates(const Step &step)
  {
    const StretchAt &smallest = run_->state.stretch.min;
    const double tiny         = tiny_step * std::min(1., 10. * run_->limiter.longest_step(step.time));
    run_->tiny_steps          = step.size > 0. && step.size < tiny ? run_->tiny_steps + 1 : 0;
    if (run_->tiny_steps > max_steps_at_zero && scene_.friction_exponent() >= 0. && smallest.value < nearly_zero)
    {
      inverted_inside(smallest.value, smallest.s, step.time);
      return true;
    }
    if (run_->tiny_steps <= max_tiny_steps)
      return false;
    run_->diagnosis = {Status::failed,
                       "step_underflow",
                       fmt::format("{} steps in succession were smaller than {:g} of the duration, at t = {:.9g}; the "
                                   "smallest stretch is {:.3g} at s = {:.6g}",
                                   max_tiny_steps,
                                   tiny,
                                   step.time * units_.time,
                                   smallest.value,
                                   smallest.s * units_.length)};
    return true;
  }

  /// State within the step that has just been made, from the integrator's dense output; kept in inside_.
  std::span<const double>
  Simulation::state_within(const double t)
  {
    inside_.y.resize(y_.size());
    inside_.v.resize(v_.size());
    integrators_.present->interpolate(t, inside_.y);
    return inside_.y;
  }

  /// Rates of the state inside_ at the time t.
  Rates
  Simulation::rates_within(const double t)
  {
    return rates_of(mesh_.assembler->integrals(t, inside_.y, inside_.v), (*mesh_.end_power)(t, inside_.y, inside_.v));
  }

  /// Integrates the rates of a step at the stages of the integrator, which uses the same quadrature. The states within
  /// the step are sampled for extremes of the stretch, too. Returns false if one of them has no velocity.
  bool
  Simulation::integrate_step(const Step &step, const Rates &at_end)
  {
    run_->quadrature.begin_step(step.size);
    if (step.size == 0.)
      return true;
    if (samples_lanes(step))
    {
      const auto last = static_cast<unsigned int>(integrators_.present->stage_places().size()) - 1;
      for (unsigned int i = 0; i < last; ++i)
        take_stage_of_lanes(step, i);
      run_->quadrature.add_stage(1., at_end);
      return true;
    }
    for (const double place : integrators_.present->stage_places())
    {
      const double t = step.time - (1. - place) * step.size;
      Rates inside   = at_end;
      if (place < 1.)
      {
        if (!finds_velocity(t, step.size, state_within(t), inside_.v))
          return false;
        inside                = rates_within(t);
        const auto [min, max] = mesh_.assembler->stretch_range(inside_.y);
        run_->recorder.see_stretch({min.value, min.s, t}, {max.value, max.s, t});
      }
      run_->quadrature.add_stage(place, inside);
    }
    return true;
  }

  /// Keeps the stretch within the step for a feedback with delay, from the integrator's dense output.
  void
  Simulation::keep_history(const Step &step, const std::span<const double> y)
  {
    if (past_.delay == 0. || step.size == 0.)
      return;
    // Start of the step from the last accepted state: the integrator may know it less well than the states inside.
    StretchHistory::Step record{run_->accepted.time, step.time, past_.cells, &mesh_.discretization->element, {}};
    for (std::size_t i = 0; i < record.u.size(); ++i)
    {
      const double place = StretchHistory::places()[i];
      const auto state   = place == 0.  ? std::span<const double>(run_->accepted.y)
                           : place < 1. ? state_within(record.from + place * (record.to - record.from))
                                        : y;
      record.u[i]        = mesh_.discretization->gather(mesh_.assembler->displacement(state));
    }
    past_.history.add(std::move(record), step.time - 2. * past_.delay);
  }

  /// Computes the displacement, and on request the energy balance, at an accepted state.
  bool
  Simulation::compute_integrals(const Step &step, const std::span<const double> y)
  {
    if (!run_->options.energy_balance && run_->observers.empty())
      return true;
    const CellIntegrals integrals = mesh_.assembler->integrals(step.time, y, v_);
    result().displacement         = integrals.displacement;
    run_->state                   = simulation_parts::numbers_of(step, integrals, run_->state.stretch, {});
    if (!run_->options.energy_balance && run_->output_times.next() > step.time + min_time_between_breaks)
      return true;
    if (!std::isfinite(integrals.dissipation))
    {
      run_->diagnosis = {
        Status::failed,
        "nonfinite",
        fmt::format("the velocity at t = {:.6g} is not a finite number; the smallest stretch is {:.3g} at s = {:.6g}",
                    step.time * units_.time,
                    run_->state.stretch.min.value,
                    run_->state.stretch.min.s * units_.length)};
      return false;
    }
    if (!run_->options.energy_balance)
      return true;
    EnergyBalance &energies = *result().energy_balance;
    const Rates now         = rates_of(integrals, (*mesh_.end_power)(step.time, y, v_));
    if (integrators_.present->stage_places().empty())
      run_->quadrature.advance(step.time, now);
    else if (!integrate_step(step, now))
      return false;
    run_->recorder.see_works(step.size, run_->quadrature.until(1.), integrals);
    if (step.number == 0)
      energies.initial_energy = integrals.elastic_energy;
    run_->state.energy_balance = energies;
    return true;
  }
} // namespace crawler
