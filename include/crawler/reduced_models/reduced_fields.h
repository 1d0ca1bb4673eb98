// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

namespace crawler
{
  /// The fields of a level that needs no mesh, at a list of points and one time, in natural units (scene.h).
  struct ReducedFields
  {
    std::vector<double> displacement; ///< zeta - s
    std::vector<double> strain, velocity, active_stress;
  };
} // namespace crawler
