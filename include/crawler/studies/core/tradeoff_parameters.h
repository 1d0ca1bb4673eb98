// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Tradeoff": the settings that `crawler tradeoff` tries, as lists (tradeoff_settings.h reads them).
  struct TradeoffParameters
  {
    std::string models          = "perturbation, kinematic, nonlinear";
    std::string formulations    = "position, stretch";
    std::string meshes          = "uniform, adaptive";
    std::string engines         = "fused, petsc, batch";
    std::string integrators     = "radau 5, radau 9, bdf";
    std::string degrees         = "2, 4, 6, 8";
    std::string cells           = "automatic";
    std::string mesh_tolerances = "logspace(-2, -8, 4)";
    std::string tolerances      = "logspace(-2, -11, 10)";
    unsigned int repetitions    = 3;
    double run_time_limit       = 10.;   ///< [s]
    double time_limit           = 3600.; ///< of all [s]

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
