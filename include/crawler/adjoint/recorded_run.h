// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_adjoint.h>
#include <crawler/run/simulation.h>

#include <functional>
#include <string>

namespace crawler
{
  /// A run in the position form by the fused engine, with all its steps: what an adjoint goes through backwards.
  struct RecordedRun
  {
    /// Why there is none for these scenes and settings; empty if there is.
    static std::string
    reason_against(const Scene &scene, const TimeParameters &time, const Numerics &numerics);

    /// Makes the run. Throws std::runtime_error if it does not finish. The scene must outlive it, and there must be no
    /// reason against it.
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
