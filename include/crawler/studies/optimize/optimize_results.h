// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>
#include <crawler/studies/optimize/optimize_start.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// What `crawler optimize` has found: for each limit of work the best of the starts.
  struct OptimizeResults
  {
    std::vector<OptimizeVariable> variables;
    std::vector<std::string> units; ///< of the variables
    std::string objective, unit;    ///< and its unit
    std::vector<StartResult> starts;
    std::vector<std::size_t> best; ///< of starts, one for each limit of work

    /// @p starts in the order of the limits of work. The best ones are chosen here.
    OptimizeResults(const OptimizeParameters &parameters,
                    std::vector<OptimizeVariable> variables,
                    const Declarations &declarations,
                    std::vector<StartResult> starts);
  };

  /// A row for each evaluation of all starts.
  Table
  evaluation_table(const OptimizeResults &results);

  /// A row for each start: the best that it has found.
  Table
  start_table(const OptimizeResults &results);

  /// The summary: that of the run of the last optimum, @p summaries of the runs of all, and what the optimiser says.
  std::string
  optimize_json(const OptimizeResults &results,
                const std::vector<std::string> &summaries,
                const std::string &status,
                const std::string &reason,
                double seconds,
                const std::string &command_line);

  /// The lines for the screen.
  std::vector<std::string>
  in_words(const OptimizeResults &results, const std::vector<std::string> &summaries);
} // namespace crawler
