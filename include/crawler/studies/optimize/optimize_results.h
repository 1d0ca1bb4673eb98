// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>
#include <crawler/studies/optimize/optimize_memory.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// What `crawler optimize` has found: for each case the best of the starts.
  struct OptimizeResults
  {
    const OptimizeNames &names;
    std::vector<StartResult> starts;
    std::vector<std::size_t> best; ///< of starts, one for each case that has a gait

    /// @p starts in the order of the cases. The best ones are chosen here.
    OptimizeResults(const OptimizeNames &names, std::vector<StartResult> starts);

    std::size_t
    n_evaluations() const;
  };

  /// A row for each optimum: that of its start in the @p folder, and what the program finds for it, by the
  /// @p summaries of their runs.
  Table
  optimum_table(const OptimizeResults &results,
                const std::filesystem::path &folder,
                const std::vector<std::string> &summaries);

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
  in_words(const OptimizeResults &results, const OptimizeCases &cases, const std::vector<std::string> &summaries);
} // namespace crawler
