// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Part of Simulation that shows its states to the observers: the ends of steps, and pictures at the requested times,
// from the integrator's dense output (doc/numerics.md, "Pictures").
#include <crawler/base/clock.h>
#include <crawler/run/simulation.h>

namespace crawler
{
  /// Examines an accepted step, and shows it to the observers if its state may be used.
  Simulation::Ending
  Simulation::see(const Step &step, const std::span<const double> y)
  {
    const EnergyBalance at_start = result().energy_balance.value_or(EnergyBalance());
    Ending ending                = examine(step, y);
    const double before          = now();
    if (ending == Ending::none && !show_pictures_within(step, step.time, at_start))
      ending = Ending::lost;
    if (ending == Ending::none)
      show_step(step, y);
    else if (step.size > 0. && !run_->observers.empty() && run_->diagnosis &&
             run_->diagnosis->status == Status::inverted)
      show_pictures_before_inversion(step);
    result().process.seconds.output += now() - before;
    return ending;
  }

  /// Shows the end of a step, or the initial state, with v_ and the data in run_.
  void
  Simulation::show_step(const Step &step, const std::span<const double> y)
  {
    const bool is_picture = run_->output_times.next() <= step.time + min_time_between_breaks;
    show(run_->state,
         y,
         v_,
         /*is_step_end=*/true,
         is_picture ? &run_->output_times.picture() : nullptr);
    if (is_picture)
      run_->output_times.pass();
  }

  /// Shows the pictures within the step that has just been made, before the time @p until, with the energies
  /// @p at_start of the step. Returns false if one of these states has no velocity.
  bool
  Simulation::show_pictures_within(const Step &step, const double until, const EnergyBalance &at_start)
  {
    for (; run_->output_times.next() < until - min_time_between_breaks; run_->output_times.pass())
    {
      const double t = run_->output_times.next();
      const auto y   = state_within(t);
      if (!mesh_.velocity->compute_within(t, step.time, step.size, y, inside_.v))
      {
        explain_no_velocity(t);
        return false;
      }
      const CellIntegrals integrals = mesh_.assembler->integrals(t, inside_.y, inside_.v);
      const StretchRange stretch    = mesh_.assembler->stretch_range(inside_.y);
      EnergyBalance energies;
      if (run_->options.energy_balance)
      {
        energies = at_start;
        energies.add_works(run_->quadrature.until(1. - (step.time - t) / step.size));
        energies.elastic_energy = integrals.elastic_energy;
      }
      Step inside = step;
      inside.time = t;
      show(simulation_parts::numbers_of(inside, integrals, stretch, energies),
           inside_.y,
           inside_.v,
           /*is_step_end=*/false,
           &run_->output_times.picture());
    }
    return true;
  }

  /// Shows the pictures before the step lost the body's stretch, from the dense output that found the time. The works
  /// until then follow from some times, since the stages may be later.
  void
  Simulation::show_pictures_before_inversion(const Step &step)
  {
    const Diagnosis inverted = *run_->diagnosis;
    // Inversions by an end condition may be known to come a little after the end of the step.
    const double start = step.time - step.size, end = std::min(result().inversion->t, step.time);
    if (run_->options.energy_balance)
    {
      run_->quadrature.begin_step(step.size);
      for (const double place : {0.1, 0.5, 0.9})
      {
        const double t = start + place * (end - start);
        const auto y   = state_within(t);
        if (!mesh_.velocity->compute_within(t, step.time, step.size, y, inside_.v))
          return;
        run_->quadrature.add_stage(t, rates_within(t));
      }
    }
    show_pictures_within(step, end, result().energy_balance.value_or(EnergyBalance()));
    run_->diagnosis = inverted;
  }

  /// Shows the row of the kymograph at a jump of the active stress once more, since a jump is not a ramp.
  void
  Simulation::show_row_after_jump()
  {
    const double t                    = run_->accepted.time;
    const PictureTimes::Time *picture = run_->output_times.passed_at(t);
    if (picture == nullptr || !picture->kinds.is_row || !finds_velocity(t, 0., y_, v_))
      return;
    const double before = now();
    const PictureTimes::Time row{picture->value, {.is_snapshot = false, .is_row = true}};
    StateNumbers numbers = simulation_parts::numbers_of(run_->state.step,
                                                        mesh_.assembler->integrals(t, y_, v_),
                                                        run_->state.stretch,
                                                        result().energy_balance.value_or(EnergyBalance()));
    numbers.step.size    = 0.;
    show(numbers, y_, v_, /*is_step_end=*/false, &row);
    result().process.seconds.output += now() - before;
  }

  /// Shows a state, whose numbers are in natural units; @p picture is null if it is none.
  void
  Simulation::show(const StateNumbers &natural,
                   const std::span<const double> y,
                   const std::span<const double> v,
                   const bool is_step_end,
                   const PictureTimes::Time *picture)
  {
    if (run_->observers.empty())
      return;
    StateNumbers numbers = natural.in_units(units_);
    if (picture != nullptr) // shown at exactly the requested time
      numbers.step.time = picture->value;
    for (const auto &observer : run_->observers)
      observer->observe({numbers,
                         is_step_end,
                         /*is_in_lost_step=*/run_->diagnosis.has_value(),
                         picture != nullptr ? picture->kinds : PictureKinds(),
                         *mesh_.assembler,
                         result().process.mesh.changes,
                         units_,
                         natural.step.time,
                         y,
                         v});
  }
} // namespace crawler
