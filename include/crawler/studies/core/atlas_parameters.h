// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Atlas": the map that `crawler atlas` makes.
  struct AtlasParameters
  {
    std::string first_axis  = "Active stress/Optimal wave/Perturbation parameter : linspace(0.01, 0.95, 48)";
    std::string second_axis = "Body/Anchoring exponent : linspace(-10, 12, 45)";
    double refinement       = 10.;
    double time_limit       = 30.; ///< [s]

    void
    add_parameters(Declarations &declarations);
  };
} // namespace crawler
