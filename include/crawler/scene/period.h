// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <optional>
#include <vector>

namespace crawler
{
  /**
   * Finds the repetition of an active stress over a body of this @p length [length] and the duration T = @p end_time
   * [time], nothing if there is none: the smallest period P <= T/2 with m(s,t+P) = m(s,t) to 1e-10 of the largest |m|
   * at five places, at 64 random times in [0, T-P] and at about 16 equally spaced ones in each period (at least 1024,
   * at most 65536); if there is none, one found likewise from T/4 on, and the smallest of T/4, T/8, ... from which on
   * it holds. Where |m_t| may be larger than in one period (fast_changes.h) m must repeat, too; if these times are too
   * many to be searched it counts as not repeating, and so does a steady stress.
   */
  std::optional<ActiveStress::Repetition>
  find_repetition(const ActiveStress &stress, double length, double end_time);

  /// The smallest common multiple of the @p periods (positive, not empty), whose ratios are fractions to 1e-10; nothing
  /// if these have numerators or denominators above 1000.
  std::optional<double>
  common_period(const std::vector<double> &periods);

  /// Shortest period of an active stress that has the period P = @p period from the time @p from on: the smallest of P,
  /// P/2, P/3, P/4, ... after which it repeats there by the test of find_repetition(); P if it is steady. Divisors with
  /// prime factors up to 7 are tried.
  double
  shortest_period(const ActiveStress &stress, double length, double period, double from);
} // namespace crawler
