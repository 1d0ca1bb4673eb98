// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation.h>

namespace crawler
{
  /// Change of the displacement, as a part of the wanted error, below which a refinement was not needed.
  inline constexpr double graded_change = 0.25;

  /// First step of a run or piece on a graded mesh [time]: the smallest cells come to rest in it, whatever the active
  /// stress did, and Newton's method converges.
  double
  first_step_on_graded_mesh(const Scene &scene, const Numerics &numerics);

  /// Settings of @p numerics, whose mesh is graded, with a mesh that is certainly finer.
  Numerics
  with_finer_grading(const Scene &scene, const Numerics &numerics);
} // namespace crawler
