// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

namespace crawler
{
  /// Fields of a level without a mesh, at a list of points and one time, in natural units (scene.h).
  struct ReducedFields
  {
    std::vector<double> displacement; ///< zeta - s
    std::vector<double> strain, velocity, active_stress;
  };
} // namespace crawler
