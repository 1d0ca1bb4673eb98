// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

/// Laws at quadrature points.
namespace crawler
{
  /**
   * Equation in a cell: the loops of cell_loops.h are the only ones in the program, for any number type and any laws
   * (cell_laws.h). Laws give, at the n points of a cell, for strains e, stretches w and velocities v and their
   * gradients v_s:
   *
   *   forces(e, w, v, N, f)        force in the body N and, unless v is null, friction per reference length f
   *   derivatives(e, w, v, D)      derivatives of both: PointDerivatives; without by_state those by v and v_s only
   *   densities(e, w, v, v_s, at)  PointDensities
   *
   * A new term of the equation is a line in each of these, and nowhere else.
   */
  template <int n, typename Number>
  struct PointDerivatives
  {
    Number f_v[n], f_w[n]; ///< derivatives of the friction by velocity and stretch
    Number N_w[n];         ///< derivative of the force in the body by the stretch; not set if laws have one k
    Number f_u[n];         ///< derivative of the friction by the place; not set unless the laws have_place()
    Number N_rate[n];      ///< derivative of the force in the body by the stretch rate; not set unless they have_rate()
  };

  template <typename Number>
  struct PointDensities
  {
    Number elastic_energy, power, force; ///< power of the active stress, friction force
  };

  /// Values of general laws at the points [cell][point] of a run of cells, for the present state; f is the friction per
  /// reference length, N the force in the body. The first two, k and m are always set; without @p f_u friction does not
  /// depend on the place, without @p N_rate the force does not depend on the stretch rate.
  template <typename Number>
  struct PointLaws
  {
    Number *N, *f, *f_u, *f_v, *w_f_w, *N_w, *N_rate, *k;
    const Number *m;
  };
} // namespace crawler
