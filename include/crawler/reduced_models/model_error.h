// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/reduced_models/strain.h>
#include <crawler/scene/scene.h>

#include <array>

namespace crawler
{
  /// Estimated model errors of the displacement of the approximate levels, in natural units.
  struct ModelErrors
  {
    bool known          = false;     ///< false if a stretch is not positive, or if the corrections do not shrink
    double perturbation = 0.;        ///< error of the series; only for the optimal wave
    double kinematic    = 0.;        ///< error of the body with the approximate strain
    double displacement = 0.;        ///< displacement after the corrections
    std::array<double, 3> changes{}; ///< changes of the displacement by the corrections
  };

  /**
   * Inserts an approximate motion into the full equation and solves for the correction (doc/numerics.md, "Model
   * error"): with the strain e of the level and its velocity v the residual is r = g v - m_s - k e_s, and
   *
   *   u_t = k u_ss - r,   u_s = 0 at the ends,
   *
   * in cosine modes, which an exponential integrator (r linear in each step) takes through time. With the strain
   * e + u_s the body travels another distance. Three corrections are made, each with the residual of the corrected
   * motion. The error is the change of the displacement by all corrections, and a twentieth more for the grid, plus
   * three times the change by the last one for the omitted ones.
   *
   * Version for the optimal wave; @p scene is in natural units.
   */
  ModelErrors
  estimate_model_errors(const Scene &scene, const NaturalWave &wave);

  /// Version for an active stress whose strain is taken as that of a stiff body, e = -m/k. The grid is doubled until
  /// the estimate changes by less than a tenth.
  ModelErrors
  estimate_model_errors(const Scene &scene, const ActiveStress &strain);
} // namespace crawler
