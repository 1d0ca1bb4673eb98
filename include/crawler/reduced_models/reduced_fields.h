// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <limits>
#include <vector>

namespace crawler
{
  /// The fields of a level that needs no mesh, at a list of points and one time, in natural units (scene.h).
  struct ReducedFields
  {
    std::vector<double> displacement; ///< zeta - s
    std::vector<double> strain, velocity, active_stress;
  };

  /// Works and energies of a level up to some time, in natural units.
  struct ReducedEnergies
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double stress_power   = 0.; ///< W = -int int m zeta_st ds dt
    double dissipation    = 0.; ///< Q = int int g v^2 ds dt
    double positive_power = 0.; ///< int int max(-m zeta_st, 0) ds dt; may be unknown
    double exchanged      = 0.; ///< int int |m zeta_st| ds dt
    double end_work       = 0.; ///< int [m v] from s = 0 to L dt; the paper's energy is W plus this
    double elastic_energy = 0.; ///< of the present state
    double elastic_start  = 0.; ///< of the initial state, which need not be at rest
  };
} // namespace crawler
