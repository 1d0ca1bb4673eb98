// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

/**
 * The equation of the limbless crawler at a material point (doc/theory.md, Eq. 1),
 *
 *   g(w) zeta_t = d/ds ( m + k (w - 1) ),   w = zeta_s,   m + k (w - 1) = 0 at both ends,
 *
 * and the densities of its energies. The unknown of the program is the displacement u = zeta - s, so w = 1 + u_s.
 * Weak form, for every test function phi:  int g v phi ds + int N phi_s ds = 0,  v = u_t,  N = m + k (w - 1).
 */
namespace crawler::equation
{
  /// N, the force in the body [force]; it vanishes at the ends.
  /// Takes the strain e = w - 1 = u_s itself: for small motions 1 + e has lost its digits.
  inline double
  body_force(const double e, const double m, const double k)
  {
    return m + k * e;
  }

  /// Elastic energy per reference length [force], for the strain e.
  inline double
  elastic_energy(const double e, const double k)
  {
    return 0.5 * k * e * e;
  }

  /// Friction force per reference length [force/length], for g = g(w).
  inline double
  friction_force(const double g, const double v)
  {
    return g * v;
  }

  /// Power lost to friction per reference length [force/time].
  inline double
  dissipation(const double g, const double v)
  {
    return g * v * v;
  }

  /// Power of the active stress per reference length [force/time], for the stretch rate v_s.
  inline double
  stress_power(const double m, const double v_s)
  {
    return -m * v_s;
  }
} // namespace crawler::equation
