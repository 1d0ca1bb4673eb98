// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Tables of a ReferenceElement. Plain data: code for all instruction sets includes it.
  struct ElementTables
  {
    const double *values;      ///< [n points][n nodes] shape functions
    const double *derivatives; ///< [n points][n nodes]
    const double *weights;     ///< [n points]
    const double *stiffness;   ///< [n nodes][n nodes]
  };
} // namespace crawler
