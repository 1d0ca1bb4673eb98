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
   * places, at 64 random times in [0, T-P] and at some 16 equally spaced ones in each period (at least 1024, at most
   * 65536); where there is none, one that is found as well from T/4 on, and the smallest of T/4, T/8, ... from which on
   * it holds. Where |m_t| may be larger than in one period (fast_changes.h) m must repeat, too; if there are more such
   * times than can be searched it does not. What does not depend on time does not repeat.
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
