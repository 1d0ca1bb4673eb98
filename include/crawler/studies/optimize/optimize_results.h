// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>
#include <crawler/studies/optimize/optimize_memory.h>

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// Results of `crawler optimize`: for each case the best of the starts.
  struct OptimizeResults
  {
    const OptimizeNames &names;
    std::vector<StartResult> starts;
    std::vector<std::size_t> best;            ///< indices of starts, one for each case that has a gait
    std::vector<nlohmann::ordered_json> runs; ///< summaries of the runs of the best ones

    /// Chooses the best of @p starts, which are in the order of the cases.
    OptimizeResults(const OptimizeNames &names, std::vector<StartResult> starts);

    std::size_t
    n_evaluations() const
    {
      std::size_t n = 0;
      for (const StartResult &start : starts)
        n += start.records.size();
      return n;
    }
  };

  /// Table with a row for each optimum: the row of its start in the @p folder, and the results of its run.
  Table
  optimum_table(const OptimizeResults &results, const std::filesystem::path &folder);

  /// Summary: that of the run of the last optimum, and the report of the optimiser. If there is a @p reason why the
  /// study did not finish, it replaces the ending of the run.
  std::string
  optimize_json(const OptimizeResults &results,
                const std::string &status,
                const std::string &reason,
                const std::string &message,
                double seconds,
                const std::string &command_line);

  /// Lines for the screen.
  std::vector<std::string>
  in_words(const OptimizeResults &results, const OptimizeCases &cases);
} // namespace crawler
