// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_adjoint.h>
#include <crawler/run/simulation.h>

#include <functional>

namespace crawler
{
  /// Run in the position form by the fused engine, with all its steps: the object that an adjoint traverses backwards.
  struct RecordedRun
  {
    /// True if this scene and these settings admit one: not for the stretch form, an initial stretch, jumps that move,
    /// feedback from elsewhere or to what jumps in time, and scenes that the fused engine does not compute.
    static bool
    is_possible(const Scene &scene, const TimeParameters &time, const Numerics &numerics);

    /// Makes the run. Throws std::runtime_error if it does not finish. The scene must outlive it; requires
    /// is_possible().
    RecordedRun(const Scene &scene,
                const TimeParameters &time,
                const Numerics &numerics,
                const std::function<bool()> &keep_going);
    RecordedRun(const RecordedRun &) = delete;

    const Scene &scene;
    const Units units;
    TimeSegments segments;
    const Scene natural; ///< the scene in natural units
    const LaneMethod method;
    LaneRecord steps;
    double displacement; ///< [length]
  };
} // namespace crawler
