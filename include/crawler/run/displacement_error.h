// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <limits>

namespace crawler
{
  /// Estimated error of a displacement and its parts; not a number where unknown [length].
  struct DisplacementError
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double total = unknown; ///< sum of the parts
    double space = unknown; ///< part of the mesh
    double time  = unknown; ///< part of the time steps, and of cycles that were extrapolated
    double model = unknown; ///< part of the model level; 0 if the full equation was solved
  };
} // namespace crawler
