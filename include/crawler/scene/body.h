// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  class Declarations;

  /// The passive body (section "Body" of the parameter file). Any consistent set of units.
  struct Body
  {
    double length               = 1.; ///< L, rest length [length]
    double elastic_modulus      = 1.; ///< k [force]
    double friction_coefficient = 1.; ///< gamma [force time/length^2]
    double anchoring_exponent   = 2.; ///< p [1]

    /// a = 1 - p, the exponent of the stretch in the friction per reference length [1].
    double
    friction_exponent() const
    {
      return 1. - anchoring_exponent;
    }

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
