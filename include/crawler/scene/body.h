// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/profile.h>

#include <string>

namespace crawler
{
  class Declarations;

  /// The passive body (section "Body" of the parameter file), in any consistent units.
  struct Body
  {
    double length               = 1.; ///< L, rest length [length]
    double elastic_modulus      = 1.; ///< k [force]
    double friction_coefficient = 1.; ///< gamma [force time/length^2]
    double anchoring_exponent   = 2.; ///< p [1]

    // Additions of a body that is not plain: formulas of s, lists or CSV files (profile.h).
    std::string elastic_modulus_profile = "1";
    std::string friction_profile        = "1";
    std::string initial_stretch         = "1";
    std::string constants               = ""; ///< of the formulas
    std::string profile_interpolation   = "cubic";

    /// Exponent of the stretch in the friction per reference length, a = 1 - p [1].
    double
    friction_exponent() const
    {
      return 1. - anchoring_exponent;
    }

    void
    add_parameters(Declarations &declarations);
  };

  /// Quantities that vary along the body; null where the factor is 1 everywhere.
  struct BodyProfiles
  {
    std::shared_ptr<const Profile> elastic_modulus; ///< k(s)/k
    std::shared_ptr<const Profile> friction;        ///< b(s), gamma(s)/gamma
    std::shared_ptr<const Profile> initial_stretch; ///< w(s, 0)

    bool
    is_plain() const
    {
      return !elastic_modulus && !friction && !initial_stretch;
    }
  };

  /// Reads the profiles of a body. Throws InputError if one has an error or is not positive.
  BodyProfiles
  read_profiles(const Body &body, double end_time);
} // namespace crawler
