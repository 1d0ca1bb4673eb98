// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Integrators of the equation of a simulation over time, how they are connected, and which of their steps are repeated.
#include <crawler/base/communication.h>
#include <crawler/run/batch.h>
#include <crawler/run/simulation.h>
#include <crawler/time/integrators.h>

#include <algorithm>
#include <stdexcept>

namespace crawler
{
  /// Chooses the fused engine where it fits and has not given up, else PETSc. The unused one is not built.
  void
  Simulation::choose_stepper()
  {
    const auto method = size_of(communicator_) == 1 ? lane_method(scene_, time_, numerics_) : std::nullopt;
    if (method && (!run_ || !run_->lanes_gave_up))
    {
      if (!integrators_.lanes)
        integrators_.lanes = std::make_unique<LaneStepper>(scene_, *method);
      integrators_.present = integrators_.lanes.get();
    }
    else
    {
      if (mesh_.position == nullptr)
        throw std::logic_error("the stretch form is for the fused engine");
      if (!integrators_.petsc)
        integrators_.petsc = petsc_stepper(communicator_, *mesh_.position, time_);
      integrators_.present = integrators_.petsc.get();
    }
  }

  /// Continues with PETSc from the last accepted state, with a step as small as the first one or the engine's.
  void
  Simulation::go_on_with_petsc(const TimeOutcome &outcome)
  {
    constexpr double smallest_step = 1e-9;
    count_part(outcome);
    run_->lanes_gave_up      = true;
    y_                       = run_->accepted.y;
    run_->accepted.next_step = std::max(std::min(outcome.step_size, numerics_.initial_step), smallest_step);
  }
} // namespace crawler
