// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/step_limits.h>
#include <crawler/scene/scene.h>

#include <cstddef>

namespace crawler
{
  /// Scales from an examination of the active stress alone: pilots cannot miss what it has seen.
  struct StressScales
  {
    double displacement; ///< displacement of the stiff body, or of the one that is held by friction [length]
    double length;       ///< largest |m| over largest |m_s| between the breaks [length]
    /// Limits of steps to the time in which m can change by the largest |m| between the breaks [time].
    std::vector<StepLimit> step_limits;
    double stress;  ///< largest |m| [force]
    bool sees_all;  ///< no event is too short to be seen: by ActiveStress::bounds(), or one stride shows all
    bool is_smooth; ///< m seems to have many derivatives along the body, between the breaks
    /// Largest sudden change that makes layers, relative to the largest |m|: of m at the ends of the body and of its
    /// jumps in space, at the start and at the breaks in time [1].
    double sudden;
    double sudden_later;           ///< largest sudden change at the breaks in time alone [1]
    std::size_t in_space, in_time; ///< numbers of breaks
    /// True if m jumps at places that are no breaks and change in time: no cell can end there.
    bool jumps_move;
  };

  StressScales
  stress_scales(const Scene &scene);

  /// Limits of the steps for a scene like one that has the limits @p known, with this largest |m| [force]; finding them
  /// takes microseconds where the generator can tell.
  std::vector<StepLimit>
  similar_step_limits(const Scene &scene, const std::vector<StepLimit> &known, double largest);
} // namespace crawler
