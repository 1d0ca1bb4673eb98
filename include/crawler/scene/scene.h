// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/body.h>
#include <crawler/scene/breaks.h>
#include <crawler/scene/friction_law.h>
#include <crawler/scene/ground.h>
#include <crawler/scene/units.h>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// The physical problem: a body on the ground, its active stress, and the duration. No numerics.
  struct Scene
  {
    Body body;
    std::shared_ptr<const FrictionLaw> friction;
    std::shared_ptr<const ActiveStress> active_stress;
    double end_time; ///< T [time]
    BodyProfiles profiles = {};
    Ground ground         = {};

    /// True if the scene is only the numbers of the body, the power law and an active stress m(s,t). Other scenes are
    /// general: they have the equation of doc/theory.md, "General bodies and grounds".
    bool
    is_plain() const
    {
      return profiles.is_plain() && ground.is_plain() && active_stress->feedback() == nullptr && friction->is_power_law;
    }

    /// True if the centre of mass stays in place, whatever the active stress: at a = 0, where friction does not depend
    /// on the stretch.
    bool
    keeps_its_centre() const
    {
      return is_plain() && body.friction_exponent() == 0.;
    }

    /// True if the motion of a body depends on its shape alone, not on its place or its past; then strides may repeat.
    bool
    is_alike_everywhere() const
    {
      const StretchFeedback *feedback = active_stress->feedback();
      return !ground.profile && (feedback == nullptr || feedback->facts.delay == 0.);
    }

    /// True if the active stress at a point depends on the stretch elsewhere.
    bool
    feels_elsewhere() const
    {
      const StretchFeedback *feedback = active_stress->feedback();
      return feedback != nullptr && feedback->facts.sees_near();
    }

    /// Features that is_plain() excludes, in words; empty if none.
    std::string
    general_features() const;

    /// General features with which a given strain does not determine the motion (given_motion.h).
    std::string
    features_beyond_strain() const;

    /// Exponent w g'/g of the friction law at small stretch, which decides what is lost there: a of the power law.
    double
    friction_exponent() const
    {
      constexpr double small = 1e-3;
      return friction->exponent(small);
    }

    /// Places in (0, L) where the active stress, also by its feedback, or a profile of the body has a jump or a kink,
    /// ascending, each once [length].
    std::vector<double>
    breaks_in_space() const;
  };

  /// The scene with smooth fronts in place of jumps that move along the body (KnownStress::with_fronts); nothing if
  /// the active stress knows none.
  std::optional<Scene>
  with_fronts(const Scene &scene, double part);

  /**
   * The units in which L = T = gamma = 1: length L, time T, force gamma L^2/T. One number of the body remains, its
   * stiffness k T/(gamma L^2) (doc/numerics.md, "Natural units"). Throws InputError if these exceed the range of double
   * precision.
   */
  Units
  natural_units(const Scene &scene);

  /// That stiffness, the elastic modulus in these units.
  double
  stiffness(const Scene &scene);

  /// Throws InputError if the active stress is not finite, or would strain the body by more than 1e20 or, unless it is
  /// 0, by less than 1e-20.
  void
  require_computable_stress(const Scene &scene);

  /// Throws InputError if at t = 0 a feedback makes the equation ill-posed: k + dm/dw (at an end that sees itself, with
  /// dm/dw_near) or dm/dw_t is negative, so that the finest scales grow without bound. Feedback that does so only
  /// later, or on one side of a kink, is not found.
  void
  require_well_posed_feedback(const Scene &scene);

  /// An active stress in other units. It refers to @p stress, which must outlive it. If @p pieces are given, which must
  /// outlive it too, it is that of the piece that is present at its evaluation.
  std::unique_ptr<const ActiveStress>
  in_units(const ActiveStress &stress, const Units &units, const TimeSegments *pieces = nullptr);

  /// The problem in other units; it refers to @p scene as its active stress does.
  Scene
  in_units(const Scene &scene, const Units &units, const TimeSegments *pieces = nullptr);
} // namespace crawler
