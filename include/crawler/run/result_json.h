// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <nlohmann/json_fwd.hpp>

namespace crawler
{
  /// What summary.json says of a result but for the process that made it (ranks, versions, command line): keys are a
  /// contract (doc/user_guide.md). What is not known is null or not a number, which is written as null.
  nlohmann::ordered_json
  summary_of(const SimulationResult &result);

  /// Of the numbers and words of a result: {key, unit, meaning}.
  nlohmann::ordered_json
  result_entries();
} // namespace crawler
