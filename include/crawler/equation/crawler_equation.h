// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>

/**
 * Equation of the limbless crawler at a material point (doc/theory.md, Eq. 1),
 *
 *   g(w) zeta_t = d/ds ( m + k (w - 1) ),   w = zeta_s,   m + k (w - 1) = 0 at both ends,
 *
 * and the densities of its energies. The unknown of the program is the displacement u = zeta - s, so w = 1 + u_s.
 * The functions are templates because packs of bodies use them, too (lanes/pack.h).
 * Weak form, for every test function phi:  int g v phi ds + int N phi_s ds = 0,  v = u_t,  N = m + k (w - 1).
 */
namespace crawler::equation::inline CRAWLER_INSTRUCTION_SET
{
  /// Force N in the body [force]; it vanishes at the ends. Takes the strain e = w - 1 = u_s itself: for small
  /// displacements 1 + e has lost its digits.
  template <typename Number>
  inline Number
  body_force(const Number e, const Number m, const Number k)
  {
    return m + k * e;
  }

  /// Active stress m of a body whose force @p N is known.
  template <typename Number>
  inline Number
  active_stress(const Number N, const Number e, const Number k)
  {
    return N - k * e;
  }

  /// Elastic energy per reference length [force], for the strain e.
  template <typename Number>
  inline Number
  elastic_energy(const Number e, const Number k)
  {
    return 0.5 * k * e * e;
  }

  /// Friction force per reference length [force/length], for g = g(w).
  template <typename Number>
  inline Number
  friction_force(const Number g, const Number v)
  {
    return g * v;
  }

  /// Factor d of the friction by the direction (scene/direction.h), and the derivative of d(v) v.
  template <typename Number>
  struct DirectionFactor
  {
    Number d, dv_v;
  };

  /// Computes it for the velocity @p v, whose tanh(v/v_s) is @p th.
  template <typename Number>
  inline DirectionFactor<Number>
  direction_factor(const Number ratio, const Number switching_velocity, const Number v, const Number th)
  {
    const Number mean = 0.5 * (1. + ratio), half = 0.5 * (1. - ratio);
    return {mean + half * th, mean + half * (th + v / switching_velocity * (1. - th * th))};
  }

  /// Factors of the friction of a general scene besides g(w): b(s) c(x) d(v) v [velocity], and its derivatives by the
  /// velocity and by the place.
  template <typename Number>
  struct Sliding
  {
    Number force, by_v, by_u;
  };

  /// Computes it from @p b of the body, @p c of the ground and its slope @p c_x, and that of the direction.
  template <typename Number>
  inline Sliding<Number>
  sliding(const Number b, const Number c, const Number c_x, const DirectionFactor<Number> &direction, const Number v)
  {
    return {b * c * direction.d * v, b * c * direction.dv_v, b * c_x * direction.d * v};
  }

  /// Power of the active stress per reference length [force/time], for the stretch rate v_s.
  template <typename Number>
  inline Number
  stress_power(const Number m, const Number v_s)
  {
    return -m * v_s;
  }
} // namespace crawler::equation::inline CRAWLER_INSTRUCTION_SET
