// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <vector>

namespace crawler
{
  /// A wave of stretch along the body, e(s - c t) as far as it is one; what does not change in time is no part of it.
  struct StretchWave
  {
    double speed;     ///< c, positive towards s = L [length/time]; means something only if the wave travels
    double coherence; ///< 1: all of it travels with this speed; 0: as much goes one way as the other

    /// Otherwise it is a standing one.
    bool
    travels() const
    {
      return coherence >= 0.1;
    }
  };

  /**
   * The wave in the samples @p stretch [phase][piece] of one period, equally spaced in time and along the body, an even
   * number of pieces. With e the stretch without its mean over time, E_n its Fourier coefficients in time, w = 2 pi/P
   * and q = 1/c a slowness,
   *
   *   S(q) = sum_n |int E_n e^(i n w q s) ds|^2 / (L sum_n int |E_n|^2 ds),   n = 1 ... 8,
   *
   * is 1 if and only if e = e(s - c t). The wave is that of the largest S, its coherence S(q) - S(-q). No derivative is
   * taken, so stretches may have steps along the body and in time.
   *
   * @p swing: how far the smallest and the largest stretch on the body move in this period, as far as it is known
   * between the samples, too. Nothing if the stretch hardly changes, or if it changes faster than the samples tell.
   */
  std::optional<StretchWave>
  measure_wave(const std::vector<std::vector<double>> &stretch, double period, double length, double swing = 0.);
} // namespace crawler
