// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/body.h>
#include <crawler/scene/direction.h>
#include <crawler/scene/friction_law.h>
#include <crawler/scene/profile.h>

#include <memory>
#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Ground" of the parameter file.
  struct GroundParameters
  {
    std::string profile                      = "1";
    std::string interpolation                = "cubic";
    std::string outside                      = "hold";
    std::string friction_law                 = "power";
    std::string expression                   = "1/w";
    std::string constants                    = "";
    double backward_ratio                    = 1.; ///< r [1]
    std::optional<double> switching_velocity = {}; ///< v_s [length/time]

    void
    add_parameters(Declarations &declarations);
  };

  /// Properties of the ground besides the friction law.
  struct Ground
  {
    std::shared_ptr<const Profile> profile; ///< c(x), null where it is 1 everywhere
    Direction direction;

    bool
    is_plain() const
    {
      return !profile && !direction.is_uneven();
    }
  };

  /// Creates the friction law that the parameters name. Throws InputError if the expression has an error, or is not
  /// positive for stretches near 1.
  std::unique_ptr<const FrictionLaw>
  create_friction_law(const GroundParameters &parameters, const Body &body, double end_time);

  /// Creates the ground. Throws InputError if the entries do not make sense.
  Ground
  create_ground(const GroundParameters &parameters, const Body &body, double end_time);
} // namespace crawler
