// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Units in which a scene is computed: a value in the user's units is the computed number times its unit.
  struct Units
  {
    double length = 1., time = 1., force = 1.;

    double
    energy() const
    {
      return force * length;
    }
    double
    power() const
    {
      return force * length / time;
    }
    double
    velocity() const
    {
      return length / time;
    }
  };
} // namespace crawler
