// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/optimal_wave.h>
#include <crawler/scene/known_stress.h>
#include <crawler/scene/scene.h>

#include <vector>

namespace crawler
{
  /// Optimal wave in natural units (L = T = gamma = 1), which leave a few numbers of it.
  struct NaturalWave
  {
    /// Harmonic n = 1, 2, ...; those of amplitude 0 are left out.
    struct Harmonic
    {
      double q;    ///< 2 pi n
      double a, b; ///< chi a_n/c and chi b_n/c: the amplitudes of the strain [1]
    };

    double speed;             ///< c T/L: strides until the end, with the sign of c
    double friction_exponent; ///< a
    double stiffness;         ///< k T/(gamma L^2)
    std::vector<Harmonic> harmonics;

    /// Largest n.
    unsigned int
    n_waves() const;
  };

  /// Optimal wave @p wave of a scene in the user's units.
  NaturalWave
  natural_wave(const Scene &scene, const OptimalWave &wave);

  /// Strain of the optimal wave to leading order in chi (theory.md, section 3), in natural units: e = sum a (sin
  /// q(s+ct) - sin q s) + b (cos q(s+ct) - cos q s).
  StressByFunctions
  leading_order_strain(const NaturalWave &wave);
} // namespace crawler
