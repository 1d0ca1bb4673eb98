// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/recorded_run.h>
#include <crawler/run/batch.h>

#include <cmath>
#include <stdexcept>

namespace crawler
{
  bool
  RecordedRun::is_possible(const Scene &scene, const TimeParameters &time, const Numerics &numerics)
  {
    const StretchFeedback *feedback = scene.active_stress->feedback();
    return !numerics.jumps_move && batch_method(scene, time, numerics) &&
           (feedback == nullptr || TimeSegments(*scene.active_stress, scene.end_time).breaks().empty());
  }

  RecordedRun::RecordedRun(const Scene &its_scene,
                           const TimeParameters &time,
                           const Numerics &numerics,
                           const std::function<bool()> &keep_going)
    : scene(its_scene)
    , units(natural_units(scene))
    , segments(*scene.active_stress, scene.end_time)
    , natural(in_units(scene, units, &segments))
    , method(batch_method(natural, time, in_units(numerics, units)).value())
  {
    const SimulationResult result = Simulation(MPI_COMM_SELF, scene, time, numerics)
                                      .run({}, {.gait = GaitWish::declared, .steps = &steps}, {}, keep_going);
    if (result.time.status != Status::finished)
      throw std::runtime_error("the run did not finish: " + result.time.message);
    displacement = result.displacement;
    double from  = 0.;
    for (std::size_t i = 0; i < steps.times.size(); ++i)
    {
      const bool follows = std::abs(steps.times[i] - steps.sizes[i] - from) <= 1e-9 * steps.sizes[i] + 1e-14;
      from               = follows ? steps.times[i] : HUGE_VAL;
    }
    if (!(std::abs(from - 1.) <= 1e-12))
      throw std::runtime_error("the fused engine did not make all steps");
  }
} // namespace crawler
