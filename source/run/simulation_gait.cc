// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The part of Simulation that watches cycles and strides (doc/numerics.md, "Cycle stop"; doc/theory.md, "Gait
// numbers").
#include <crawler/run/simulation.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  /// Looks at the phases of a cycle that a step has passed: may the run end here?
  bool
  Simulation::cycle_repeats(const Step &step, const std::span<const double> y)
  {
    const auto see = [&](const std::span<const double> state) {
      const double extremes[] = {result_.min_stretch.value, result_.max_stretch.value};
      double g[2];
      scene_.friction->values(extremes, g);
      return cycle_stop_->observe(assembler_->displacement_at(CycleStop::n_pieces, state),
                                  assembler_->integrals(step.time, state, v_).displacement,
                                  result_.energy_balance ? &*result_.energy_balance : nullptr,
                                  scene_.body.elastic_modulus / std::max(g[0], g[1]));
    };
    y_inside_.resize(y_.size());
    for (; !cycle_stop_->next_is_end() && cycle_stop_->next_time() <= step.time; see(y_inside_))
      stepper_->interpolate(cycle_stop_->next_time(), y_inside_);
    const bool is_end = step.is_output_time && cycle_stop_->next_is_end() &&
                        std::abs(cycle_stop_->next_time() - step.time) < 1e-6 * step.size;
    return is_end && see(y);
  }

  /// A step shall end where the last stride starts, so that what it costs is known.
  void
  Simulation::prepare_gait()
  {
    const auto period = stride_of(*scene_.active_stress, 1., 1.);
    // To look for one costs a thousand looks at the state.
    constexpr std::size_t most_unknowns = 10000;
    if (!period && (options_.gait == GaitWish::declared || discretization_->n_unknowns() > most_unknowns))
      return;
    gait_meter_.emplace(period, cycle_stop_.has_value());
    const auto start = gait_meter_->stride_start();
    if (!start)
      return;
    const double time = *start * units_.time;
    const auto place  = std::lower_bound(output_times_.begin(), output_times_.end(), time - 1e-12 * units_.time);
    if (place != output_times_.end() && *place <= time + 1e-12 * units_.time)
      return;
    hidden_output_time_ = time;
    output_times_.insert(place, time);
  }

  /// Shows the gait's samples that a step has passed.
  void
  Simulation::watch_gait(const Step &step, const std::span<const double> y)
  {
    const auto see = [&](const std::span<const double> state) {
      const auto u = assembler_->displacement_at(GaitMeter::n_pieces, state);
      gait_meter_->see(u, assembler_->integrals(step.time, state, v_).displacement);
    };
    y_inside_.resize(y_.size());
    constexpr double same_time = 1e-12;
    for (double time = gait_meter_->next_time(); time <= step.time + same_time; time = gait_meter_->next_time())
      if (time >= step.time - same_time || step.size == 0.)
        see(y);
      else
      {
        stepper_->interpolate(time, y_inside_);
        see(y_inside_);
      }
    gait_meter_->see_extremes(stretch_.min.value, stretch_.max.value);
    // With an energy balance or observers the displacement of this state is known already.
    const bool is_known = options_.energy_balance || has_observers_;
    gait_meter_->see_step(step.time,
                          is_known ? result_.displacement : assembler_->integrals(step.time, y, v_).displacement,
                          result_.energy_balance ? &*result_.energy_balance : nullptr);
  }
} // namespace crawler
