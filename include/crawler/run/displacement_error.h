// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <limits>

namespace crawler
{
  /// The estimated error of a displacement and what it is made of; not a number where nothing is known [length].
  struct DisplacementError
  {
    static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

    double total = unknown; ///< the sum of the parts
    double space = unknown; ///< of the mesh
    double time  = unknown; ///< of the time steps, and of cycles that were extrapolated
    double model = unknown; ///< of the model level; 0 if the whole equation was solved
  };
} // namespace crawler
