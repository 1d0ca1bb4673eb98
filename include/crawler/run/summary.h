// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/unit_names.h>

#include <nlohmann/json_fwd.hpp>

#include <string>
#include <vector>

namespace crawler
{
  /// Contents of summary.json for a result without the process that made it (ranks, versions, command line): keys are a
  /// contract (doc/user_guide.md). Unknown values are null or not a number, which is written as null.
  nlohmann::ordered_json
  summary_of(const SimulationResult &result);

  /// Entries {key, unit, meaning} of the numbers and words of a result.
  nlohmann::ordered_json
  result_entries();

  /// Text of summary.json.
  std::string
  summary_json(const SimulationResult &result, unsigned int n_ranks, const std::string &command_line);

  /// Summary for people, in a few lines.
  std::vector<std::string>
  summary_lines(const SimulationResult &result, const UnitNames &units = {});
} // namespace crawler
