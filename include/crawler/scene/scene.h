// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/body.h>
#include <crawler/scene/friction_law.h>

#include <memory>

namespace crawler
{
  /// The physical problem: a body on the ground, what drives it, and for how long. No numerics.
  struct Scene
  {
    Body body;
    std::unique_ptr<const FrictionLaw> friction;
    std::unique_ptr<const ActiveStress> active_stress;
    double end_time; ///< T [time]
  };
} // namespace crawler
