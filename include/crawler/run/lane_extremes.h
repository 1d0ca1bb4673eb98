// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/extreme_history.h>
#include <crawler/lanes/lane_tables.h>
#include <crawler/run/simulation_result.h>

#include <utility>
#include <vector>

namespace crawler
{
  /**
   * Smallest and largest stretch that the fused engine has seen in stage @p i of @p step, of the position form, as by
   * Assembler::stretch_range(), in natural units. If a sample may be a new extreme beyond those @p so_far, the parabola
   * through its neighbours in the cell comes closer. At @p breaks, in lengths of the body, the stretch may jump.
   */
  std::pair<Extreme, Extreme>
  lane_extremes(const LaneTables &tables,
                const LaneStep &step,
                unsigned int i,
                const SimulationResult &so_far,
                const std::vector<double> &breaks);
} // namespace crawler
