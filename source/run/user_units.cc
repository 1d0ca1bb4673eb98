// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/run/gait_efficiency.h>
#include <crawler/run/user_units.h>
#include <crawler/scene/scene.h>

namespace crawler
{
  SimulationResult
  in_user_units(SimulationResult result, const Scene &scene, const Units &units)
  {
    const auto scale = [&units](Extreme &extreme) {
      extreme.s *= units.length;
      extreme.t *= units.time;
    };
    result.time.time = result.time.status == Status::finished ? scene.end_time : result.time.time * units.time;
    result.time.step_size *= units.time;
    for (double *length :
         {&result.displacement, &result.largest_u, &result.last_u, &result.strain, &result.largest_indicator})
      *length *= units.length;
    if (result.error)
      for (double *part : {&result.error->total, &result.error->space, &result.error->time, &result.error->model})
        *part *= units.length;
    if (result.energy_balance)
      result.energy_balance = result.energy_balance->scaled(units.energy());
    scale(result.min_stretch);
    scale(result.max_stretch);
    if (result.inversion)
      scale(*result.inversion);
    if (result.inverted_places)
      result.inverted_places = {result.inverted_places->first * units.length,
                                result.inverted_places->second * units.length};
    if (result.cycles)
    {
      result.cycles->period *= units.time;
      result.cycles->bound *= units.length;
    }
    if (result.gait)
      result.gait = result.gait->in_units(units);
    set_efficiencies(scene, result);
    return result;
  }
} // namespace crawler
