// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cmath>

namespace crawler
{
  /// Two places between which a function may jump, and its values there.
  struct JumpBracket
  {
    double left = 0., right = 0., f_left = 0., f_right = 0.;

    double
    change() const
    {
      return std::abs(f_right - f_left);
    }
    double
    middle() const
    {
      return 0.5 * (left + right);
    }

    /// Bisects the bracket @p n times, towards the larger change of @p function, as long as it changes by more than @p
    /// least: without a jump the change shrinks.
    template <typename Function>
    void
    narrow(const Function &function, const unsigned int n, const double least)
    {
      for (unsigned int i = 0; i < n && change() > least; ++i)
      {
        const double place = middle(), f = function(place);
        const bool in_left           = std::abs(f - f_left) > std::abs(f_right - f);
        (in_left ? right : left)     = place;
        (in_left ? f_right : f_left) = f;
      }
    }
  };
} // namespace crawler
