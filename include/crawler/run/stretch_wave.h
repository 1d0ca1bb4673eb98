// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <vector>

namespace crawler
{
  /// Wave of stretch along the body, e(s - c t) as far as it is one; the part constant in time is excluded.
  struct StretchWave
  {
    double speed;     ///< c, positive towards s = L [length/time]; meaningful only if the wave travels
    double coherence; ///< 1: all of it travels with this speed; 0: equal parts travel both ways

    /// True for a travelling wave, false for a standing one.
    bool
    travels() const
    {
      return coherence >= 0.1;
    }
  };

  /**
   * Wave in the samples @p stretch [phase][piece] of one period, equally spaced in time and along a body of length 1,
   * an even number of pieces. With e the stretch without its mean over time, E_n its Fourier coefficients in time, w =
   * 2 pi/P and q = 1/c a slowness,
   *
   *   S(q) = sum_n |int E_n e^(i n w q s) ds|^2 / (sum_n int |E_n|^2 ds),   n = 1 ... 8,
   *
   * is 1 if and only if e = e(s - c t). The wave is that of the largest S, its coherence S(q) - S(-q). No derivative is
   * taken, so stretches may have steps along the body and in time.
   *
   * @p swing: range of motion of the smallest and the largest stretch on the body in this period, as far as it is known
   * between the samples, too. Nothing if the stretch hardly changes, or if it changes faster than the samples tell.
   */
  std::optional<StretchWave>
  measure_wave(const std::vector<std::vector<double>> &stretch, double period, double swing = 0.);
} // namespace crawler
