// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Part of Simulation that takes the numbers that the fused engine computed in the stages of a step, instead of
// evaluating all of them again.
#include <crawler/run/lane_extremes.h>
#include <crawler/run/simulation.h>

#include <algorithm>

namespace crawler
{
  /// True if the numbers of the lanes in this step, where no stretch is nearly lost, may be taken.
  bool
  Simulation::samples_lanes(const Step &step) const
  {
    if (!integrators_.lanes || !integrators_.lanes->look_inside || step.size == 0.)
      return false;
    const LaneStep &seen = integrators_.lanes->lane_step();
    const std::span<const LaneStage> stages(seen.stages, integrators_.lanes->tables().setup.n_stages);
    return seen.is_settled &&
           std::ranges::all_of(stages, [](const LaneStage &stage) { return stage.min_stretch > small_stretch; });
  }

  /// Extreme stretches at the end of the step, among the samples.
  StretchRange
  Simulation::stretch_of_lanes() const
  {
    const LaneStepper &lanes = *integrators_.lanes;
    const LaneStage &end     = lanes.lane_step().stages[lanes.tables().setup.n_stages - 1];
    return {{end.min_stretch, lanes.tables().place_of_sample(end.min_sample)},
            {end.max_stretch, lanes.tables().place_of_sample(end.max_sample)}};
  }

  /// Observes the stretch of stage @p i of an accepted step; with observers its end has that of run_->state.stretch.
  void
  Simulation::see_stretch_of_lanes(const unsigned int i)
  {
    const LaneStepper &lanes = *integrators_.lanes;
    auto [smallest, largest] = lane_extremes(lanes.tables(), lanes.lane_step(), i, result(), breaks_);
    if (!run_->observers.empty() && i + 1 == lanes.tables().setup.n_stages)
    {
      const auto &[min, max] = run_->state.stretch;
      smallest               = {min.value, min.s, smallest.t, smallest.jump};
      largest                = {max.value, max.s, largest.t, largest.jump};
    }
    run_->recorder.see_stretch(smallest, largest);
  }

  /// Takes stretch and rates of stage @p i of an accepted step.
  void
  Simulation::take_stage_of_lanes(const Step &step, const unsigned int i)
  {
    const LaneStepper &lanes = *integrators_.lanes;
    const LaneStage &stage   = lanes.lane_step().stages[i];
    const double place       = lanes.tables().setup.method.c[i];
    see_stretch_of_lanes(i);
    const double end_power = mesh_.end_power->of_ends({step.time - (1. - place) * step.size,
                                                       {{stage.end_stretch[0], stage.end_stretch[1]}},
                                                       {{stage.end_rate[0], stage.end_rate[1]}},
                                                       {{stage.left_velocity, stage.right_velocity}}});
    run_->quadrature.add_stage(place, rates_of(stage, end_power));
  }

  /// Takes stretch and works of an accepted step, if no observer needs more of its end.
  void
  Simulation::sample_lanes(const Step &step)
  {
    const unsigned int last = integrators_.lanes->tables().setup.n_stages - 1;
    run_->quadrature.begin_step(step.size);
    for (unsigned int i = 0; i <= last; ++i)
      take_stage_of_lanes(step, i);
    run_->recorder.see_works(step.size, run_->quadrature.until(1.), integrators_.lanes->lane_step().stages[last]);
  }
} // namespace crawler
