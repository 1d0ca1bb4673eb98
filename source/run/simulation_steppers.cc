// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Who integrates the equation of a simulation over time, how they are connected, and which of their steps are made
// again.
#include <crawler/base/communication.h>
#include <crawler/run/batch.h>
#include <crawler/run/simulation.h>
#include <crawler/time/integrators.h>

#include <algorithm>
#include <stdexcept>

namespace crawler
{
  bool
  Simulation::lanes_fit() const
  {
    return size_of(communicator_) == 1 && lane_method(scene_, time_, numerics_);
  }

  /// The fused engine where it fits and has not given up, else PETSc. What is not used is not built.
  void
  Simulation::choose_stepper()
  {
    if (numerics_.linear)
    {
      if (!linear_stepper_)
        build_linear_stepper();
      stepper_ = linear_stepper_.get();
    }
    else if (!lanes_gave_up_ && lanes_fit())
    {
      if (!lane_stepper_)
        lane_stepper_ = std::make_unique<LaneStepper>(scene_, *lane_method(scene_, time_, numerics_));
      stepper_ = lane_stepper_.get();
    }
    else
    {
      if (position_ == nullptr)
        throw std::logic_error("the stretch form is for the fused engine");
      if (!petsc_stepper_)
        petsc_stepper_ = std::make_unique<TimeStepper>(communicator_, *position_, time_);
      stepper_ = petsc_stepper_.get();
    }
    if (keeps_rate())
      stepper_->stage_rates = [this](const double t, const std::span<const double> y_dot) { keep_rate(t, y_dot); };
  }

  /// PETSc takes the last accepted state, with a step that is as small as the first one, or as the engine wanted it.
  void
  Simulation::go_on_with_petsc(const TimeOutcome &outcome)
  {
    constexpr double smallest_step = 1e-9;
    count_part(outcome);
    lanes_gave_up_ = true;
    y_             = accepted_;
    next_step_     = std::max(std::min(outcome.step_size, numerics_.initial_step), smallest_step);
  }

  void
  Simulation::build_linear_stepper()
  {
    if (scene_.body.friction_exponent() != 0. || !scene_.is_plain() || numerics_.mesh.tolerance > 0. ||
        position_ == nullptr || integrator(time_.integrator).petsc_type != "radau")
      throw std::logic_error("the linear model is for a = 0, the position form, uniform meshes and radau");
    linear_stepper_ = std::make_unique<LinearStepper>(
      scene_, *discretization_, integrator(time_.integrator).n_stages, time_.step_control == "adaptive");
  }

  /// The limit of steps at this time.
  double
  Simulation::longest_step(const double t) const
  {
    const auto after =
      std::find_if(step_limits_.begin(), step_limits_.end(), [t](const StepLimit &limit) { return limit.from > t; });
    return after == step_limits_.begin() ? HUGE_VAL : std::prev(after)->longest;
  }

  /// Did the active stress do something within the step that its ends do not show? Then the step is made again, by
  /// shorter ones.
  bool
  Simulation::passed_over_event(const Step &step)
  {
    constexpr double shortest = 1e-6, part = 0.125;
    if (!watch_ || step.size <= shortest || watch_->is_calm(step.time - step.size, step.time))
      return false;
    const auto after = std::find_if(
      step_limits_.begin(), step_limits_.end(), [&](const StepLimit &limit) { return limit.from > step.time; });
    const StepLimit later{step.time, longest_step(step.time)};
    const auto begin = std::find_if(step_limits_.begin(), step_limits_.end(), [&](const StepLimit &limit) {
      return limit.from > step.time - step.size;
    });
    const auto place = step_limits_.erase(begin, after);
    step_limits_.insert(place, {{step.time - step.size, part * step.size}, later});
    request_ = Request::retry;
    return true;
  }
} // namespace crawler
