// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/unit_names.h>

#include <string>
#include <vector>

namespace crawler
{
  /// Text of summary.json.
  std::string
  summary_json(const SimulationResult &result, unsigned int n_ranks, const std::string &command_line);

  /// Summary for people, in a few lines.
  std::vector<std::string>
  summary_lines(const SimulationResult &result, const UnitNames &units = {});
} // namespace crawler
