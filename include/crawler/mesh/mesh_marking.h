// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/discretization.h>

namespace crawler
{
  /// Limits of an adaptive mesh.
  struct MeshLimits
  {
    double tolerance        = 0.; ///< admissible sum of all error indicators [length]; 0: the mesh does not change
    double smallest_cell    = 0.; ///< [length]
    unsigned int most_cells = 100000;
  };

  /**
   * Marks the cells to divide, by the @p indicators of all cells, so that the sum of the indicators falls below the
   * tolerance: those with the largest indicators, until the others together have less than a tenth of it; and their
   * neighbours, since waves travel. Empty if the limits forbid to divide any of them.
   */
  std::vector<CellChange>
  mark_for_division(const std::vector<double> &indicators, const Discretization &mesh, const MeshLimits &limits);

  /// Marks the cells to join: pairs whose indicators would, after joining, stay below their share of a hundredth of the
  /// tolerance. Empty if they are too few to be worth a change.
  std::vector<CellChange>
  mark_for_joining(const std::vector<double> &indicators, const Discretization &mesh, const MeshLimits &limits);
} // namespace crawler
