// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/optimize_start.h>
#include <crawler/studies/sweep/point_table.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class OptimizeCases;

  /// Cases, variables and objective of an optimisation, as its tables name them.
  struct OptimizeNames
  {
    struct Case
    {
      std::vector<std::string> values; ///< of the axes
      std::vector<std::string> paths;  ///< of the variables
      std::string words;               ///< empty if there is only one
      double sign;                     ///< of the wanted direction
    };
    std::vector<std::string> axes;
    std::vector<Case> cases;
    std::vector<std::string> paths, units; ///< of the variables of any case
    std::string objective, unit;           ///< and its unit

    explicit OptimizeNames(OptimizeCases &cases);
  };

  /// Rows for all evaluations of these starts, for each the best that it has found, and for those that are optima:
  /// without the numbers that are known nowhere.
  Table
  evaluation_table(const OptimizeNames &names, const std::vector<StartResult> &starts);
  Table
  start_table(const OptimizeNames &names, const std::vector<StartResult> &starts);
  Table
  record_table(const OptimizeNames &names, const std::vector<const StartResult *> &starts);

  /**
   * The starts that have ended, on the rank that keeps them: rows of starts.h5, and those of their evaluations in
   * results.h5 (contracts, doc/optimize.md). Rows come as starts end, behind those that are there; what is read again
   * is what is whole in both.
   */
  class OptimizeMemory
  {
  public:
    static const std::string file; ///< starts.h5

    /// @p plan: what the answers depend on.
    OptimizeMemory(OptimizeNames names, PlannedRows plan, std::string command_line);

    /// As begin_or_resume() of a table. Throws what that throws.
    void
    begin_or_resume(StudyFolder &folder, const ParameterFile &file);

    /// This start, if it has ended.
    const StartResult *
    find(const StartName &start) const;

    /// Writes a start, instead of what there is of it. Throws FileError.
    void
    keep(StartResult start);

    /// Leaves what @p starts names, in this order.
    void
    arrange(const std::vector<StartName> &starts);

    const std::vector<StartResult> &
    starts() const
    {
      return starts_;
    }
    const OptimizeNames &
    names() const
    {
      return names_;
    }

  private:
    void
    read();
    void
    write_all(unsigned long spare);
    void
    write(const StartResult &start);

    const OptimizeNames names_;
    PlannedRows plan_;
    const std::string command_line_;
    const PointTable table_;
    std::filesystem::path folder_;
    std::vector<StartResult> starts_; ///< in the order of their rows
    std::unique_ptr<RowFile> start_rows_, evaluations_;
    unsigned long n_starts_ = 0, n_evaluations_ = 0;       ///< rows that are written
    unsigned long most_starts_ = 0, most_evaluations_ = 0; ///< places for rows
  };
} // namespace crawler
