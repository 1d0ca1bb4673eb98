// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>

namespace crawler
{
  class ActiveStress;

  /**
   * The smallest period P <= T/2 of an active stress over a body of this @p length [length] and the duration
   * T = @p end_time [time], nothing if there is none: m(s,t+P) = m(s,t) to 1e-10 of the largest |m| at five places, at
   * 1024 equally spaced and 64 other times in [0, T-P]. An event that is shorter than T/1024 can be missed. What does
   * not depend on time has no period.
   */
  std::optional<double>
  find_period(const ActiveStress &stress, double length, double end_time);
} // namespace crawler
