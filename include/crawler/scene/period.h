// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <optional>
#include <vector>

namespace crawler
{
  /**
   * How an active stress over a body of this @p length [length] and the duration T = @p end_time [time] repeats,
   * nothing if it does not: the smallest period P <= T/2 with m(s,t+P) = m(s,t) to 1e-10 of the largest |m| at five
   * places, at 1024 equally spaced and 64 other times in [0, T-P]; where there is none, one that is found as well from
   * T/4 on, and the smallest of T/4, T/8, ... from which on it holds. What the stress knows to be faster
   * (fast_changes.h) must repeat, too. What does not depend on time does not repeat.
   */
  std::optional<ActiveStress::Repetition>
  find_repetition(const ActiveStress &stress, double length, double end_time);

  /// The smallest time that is a whole number of times each of the @p periods (positive, not empty), which are equal to
  /// fractions of each other to 1e-10; nothing if these have numerators or denominators above 1000.
  std::optional<double>
  common_period(const std::vector<double> &periods);

  /// The smallest of P, P/2, P/3, P/4, ... after which an active stress that has the period P = @p period from the time
  /// @p from on repeats there, found as by find_repetition(); P if it does not change. Whole parts with prime factors
  /// up to 7 are looked at.
  double
  shortest_period(const ActiveStress &stress, double length, double period, double from);
} // namespace crawler
