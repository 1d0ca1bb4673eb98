// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// Rule that gives the mobility of a node from those of the adjacent cells.
  enum class NodeRule : unsigned char
  {
    friction, ///< mean of their frictions
    fronts,   ///< mean of their frictions, but of their mobilities where the emptier cell receives
    upwind    ///< mobility of the cell that gives, with van Leer's correction
  };

  /// Settings of the stretch form for a scene (equation/stretch_loops.h, lanes/lane_stretch.h).
  struct StretchMethod
  {
    NodeRule node_rule = NodeRule::friction;
    /// True if the unknown is w^(1+a)/(1+a), which passes 0 at a finite rate where a plain body inverts (-1 < a < 0).
    bool is_power = false;
  };

  /// Laws at all cells for the present state: the mobility 1/(g b), the force N, and their derivatives by the unknowns
  /// and by the stretch rates; without @p force_by_rate the force does not depend on these.
  template <typename Number>
  struct CellLaws
  {
    const Number *mobility, *mobility_slope, *force, *force_slope, *force_by_rate;
  };
} // namespace crawler
