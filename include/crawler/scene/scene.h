// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/body.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/friction_law.h>
#include <crawler/scene/ground.h>
#include <crawler/scene/units.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// The physical problem: a body on the ground, what drives it, and for how long. No numerics.
  struct Scene
  {
    Body body;
    std::unique_ptr<const FrictionLaw> friction;
    std::unique_ptr<const ActiveStress> active_stress;
    double end_time; ///< T [time]
    BodyProfiles profiles = {};
    Ground ground         = {};

    /// Nothing but the numbers of the body, the power law and an active stress m(s,t)? Other scenes are general: they
    /// have the equation of doc/theory.md, "General bodies and grounds".
    bool
    is_plain() const;

    /// Does the centre of mass stay where it is, whatever the active stress does? At a = 0, where friction does not
    /// depend on the stretch.
    bool
    keeps_its_centre() const;

    /// Is the friction law the power law?
    bool
    has_power_law() const;

    /// Does what a body does depend on its shape alone, not on its place or its past? Then strides may repeat.
    bool
    is_alike_everywhere() const;

    /// What is_plain() misses, in words; empty if nothing.
    std::string
    general_features() const;

    /// Of these, with what a given strain does not say how the body moves (given_motion.h).
    std::string
    features_beyond_strain() const;

    /// w g'/g of the friction law where the stretch is small, which decides what is lost there: a of the power law.
    double
    friction_exponent() const;

    /// The elastic modulus at s = 0 and s = L [force].
    std::pair<double, double>
    end_moduli() const;

    /// Places in (0, L) where the active stress or a profile of the body has a jump or a kink, ascending, each once
    /// [length].
    std::vector<double>
    breaks_in_space() const;
  };

  /**
   * The units in which L = T = gamma = 1: length L, time T, force gamma L^2/T. What is left of the body is one number,
   * its stiffness k T/(gamma L^2) (doc/numerics.md, "Natural units"). Throws InputError if these are beyond what double
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
  in_units(const Scene &scene, const Units &units, const TimeSegments *pieces = nullptr);
} // namespace crawler
