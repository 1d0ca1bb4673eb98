// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/reduced_models/strain.h>
#include <crawler/scene/scene.h>

#include <array>

namespace crawler
{
  /// Estimated errors of the displacement that the approximate levels have because of their model, in natural units.
  struct ModelErrors
  {
    bool known          = false;     ///< not if a stretch is not positive, or if the corrections do not become smaller
    double perturbation = 0.;        ///< of the series; only for the optimal wave
    double kinematic    = 0.;        ///< of the body with the approximate strain
    double displacement = 0.;        ///< after the corrections
    std::array<double, 3> changes{}; ///< of the displacement by each of the corrections
  };

  /**
   * Inserts an approximate motion into the full equation and solves for what is missing (doc/numerics.md, "Model
   * error"): with the strain e of the level and its velocity v the residual is r = g v - m_s - k e_s, and
   *
   *   u_t = k u_ss - r,   u_s = 0 at the ends,
   *
   * in cosine modes, which an exponential integrator (r linear in each step) takes through time. With the strain
   * e + u_s the body goes another distance. This is done three times, with the residual of the corrected motion. The
   * error is the change of the displacement by all corrections, and a twentieth more for the grid, plus three times the
   * change by the last one for what follows.
   *
   * This one is for the optimal wave; @p scene is in natural units.
   */
  ModelErrors
  estimate_model_errors(const Scene &scene, const NaturalWave &wave);

  /// The same for an active stress that is taken for that of a stiff body, e = -m/k. The grid is doubled until the
  /// estimate does not change by more than a tenth.
  ModelErrors
  estimate_model_errors(const Scene &scene, const StiffStrain &strain);
} // namespace crawler
