// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/body.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/friction_law.h>
#include <crawler/scene/units.h>

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

  /**
   * The units in which L = T = gamma = 1: length L, time T, force gamma L^2/T. What is left of the body is one number,
   * its stiffness k T/(gamma L^2) (doc/theory.md, "Five numbers"). Throws InputError if these are beyond what double
   * precision can carry.
   */
  Units
  natural_units(const Scene &scene);

  /// Throws InputError if the active stress is not finite, or would strain the body by more than 1e20 or, if it is not
  /// 0, less than 1e-20.
  void
  require_computable_stress(const Scene &scene);

  /// The same problem in other units. It refers to @p scene, which must outlive it. If @p pieces are given, which must
  /// outlive it too, the active stress is that of the piece that is the present one when it is evaluated.
  Scene
  in_units(const Scene &scene, const Units &units, const TimePieces *pieces = nullptr);
} // namespace crawler
