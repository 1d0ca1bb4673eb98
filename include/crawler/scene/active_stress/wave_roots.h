// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

namespace crawler
{
  struct Body;

  /// Fourier coefficients of the velocity wave, n = 1, 2, ...; both lists have one length.
  struct WaveShape
  {
    std::vector<double> a; ///< a_n, sine coefficients [length/time]
    std::vector<double> b; ///< b_n, cosine coefficients [length/time]

    double
    power(unsigned int n) const ///< P_n = a_n^2 + b_n^2, with n counted from 1
    {
      return a[n - 1] * a[n - 1] + b[n - 1] * b[n - 1];
    }
    /// Delta_2 = (1/4) sum P_n [length^2/time^2]
    double
    delta_2() const;
  };

  /// A wave that spends the energy H, with its properties in the leading-order theory.
  struct WaveRoot
  {
    double speed;        ///< c [length/time], with the sign that moves the body to +s
    double multiplier;   ///< alpha = a/(L gamma c)
    double displacement; ///< of the body at the end time, leading order in chi [length]
    double min_stretch;  ///< over the body and the duration, leading order in chi [1]
    double max_stretch;

    /// True if the body stays uninverted in the leading-order theory.
    bool
    admissible() const
    {
      return min_stretch > 0.;
    }
  };

  struct WaveRoots
  {
    std::vector<WaveRoot> roots; ///< slowest wave first
    bool double_roots;           ///< H is the smallest admissible one: infinitely many
    bool complete;               ///< false if there are further, faster waves
    double smallest_energy = 0;  ///< 2 L gamma T Delta_2 [force length / chi^2]
    double largest_energy  = 0;  ///< waves exist below this energy only
  };

  /// Properties of the wave with speed @p c (any sign).
  WaveRoot
  describe_wave(const Body &body, const WaveShape &shape, double chi, double end_time, double c);

  /**
   * Waves of the given shape whose energy H is @p energy: the roots c of H = 2 L gamma T Delta_2 + (L k/c^2) sum P_n
   * sin^2(pi n c T/L) (theory.md, section 3), with the sign of c that moves the body to +s (the mirrored wave -c spends
   * the same energy). The list ends when there are at least @p at_least roots and ten admissible ones if there are
   * infinitely or very many. It is empty if H is not between smallest_energy and largest_energy.
   *
   * With x = c T/L and h = (H - 2 L gamma T Delta_2) L/(k T^2) the equation is h x^2 = sum P_n sin^2(pi n x). At
   * h = 0 (to 1e-12 of H) every root is a double one, where all sines vanish: no sign changes there.
   */
  WaveRoots
  find_wave_roots(
    const Body &body, const WaveShape &shape, double chi, double end_time, double energy, unsigned int at_least = 25);
} // namespace crawler
