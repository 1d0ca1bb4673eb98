// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Direction-dependent resistance of a ground, d(v) = (1+r)/2 + (1-r)/2 tanh(v/v_s) (equation::direction_factor). The
  /// force d(v) v increases with v for 0.1 <= r <= 10, so the velocity of a body is unique.
  struct Direction
  {
    double ratio              = 1.; ///< r, resistance for v < 0 over that for v > 0
    double switching_velocity = 1.; ///< v_s [length/time]

    bool
    is_uneven() const
    {
      return ratio != 1.;
    }
  };
} // namespace crawler
