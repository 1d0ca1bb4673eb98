// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/energy_balance.h>
#include <crawler/reduced_models/reduced_fields.h>
#include <crawler/reduced_models/strain.h>
#include <crawler/scene/strain_extremes.h>

namespace crawler
{
  /**
   * Level "perturbation": the optimal wave to leading order in chi, in closed form (doc/theory.md, "The model
   * hierarchy"; Santhosh and Serra @cite SanthoshSerra2022). In natural units, with A_n^2 = a_n^2 + b_n^2 of the
   * strain:
   *
   *   D(t) = -(a c/2) sum A_n^2 t + (a/(4 pi)) sum (A_n^2/n) sin(2 pi n c t),
   *   Q(t) = (c^2/2) sum A_n^2 t,   E(t) = (k/2) sum A_n^2 (1 - cos 2 pi n c t),   W = Q + E, which is chi^2 H.
   */
  namespace perturbation
  {
    /// Displacement of the centre of mass, of order chi^2.
    double
    displacement(const NaturalWave &wave, double t);

    /// Velocity: its derivative.
    double
    velocity(const NaturalWave &wave, double t);

    /// Energies to leading order; the positive work of the actuator is not known.
    EnergyBalance
    energies(const NaturalWave &wave, double t);

    /// Fields to order chi at @p points, moved along with the centre of mass.
    ReducedFields
    fields(const NaturalWave &wave, double t, const std::vector<double> &points);

    /// Extremes over the whole run.
    StrainExtremes
    extremes(const NaturalWave &wave);
  } // namespace perturbation
} // namespace crawler
