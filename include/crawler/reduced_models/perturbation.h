// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/cell_kernels.h>
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
  class Perturbation
  {
  public:
    explicit Perturbation(const NaturalWave &wave)
      : wave_(wave)
    {
    }

    /// Displacement of the centre of mass, of order chi^2.
    double
    displacement(double t) const;

    /// Velocity: its derivative.
    double
    velocity(double t) const;

    /// Energies to leading order; the positive work of the actuator is not known.
    EnergyBalance
    energies(double t) const;

    /// Fields to order chi at @p points, moved along with the centre of mass.
    ReducedFields
    fields(double t, const std::vector<double> &points) const;

    /// Extremes over the whole run.
    StrainExtremes
    extremes() const;

  private:
    const NaturalWave wave_;
  };
} // namespace crawler
