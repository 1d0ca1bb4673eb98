// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <nlohmann/json_fwd.hpp>

namespace crawler
{
  /// Contents of summary.json for a result without the process that made it (ranks, versions, command line): keys are a
  /// contract (doc/user_guide.md). Unknown values are null or not a number, which is written as null.
  nlohmann::ordered_json
  summary_of(const SimulationResult &result);

  /// Entries {key, unit, meaning} of the numbers and words of a result.
  nlohmann::ordered_json
  result_entries();
} // namespace crawler
