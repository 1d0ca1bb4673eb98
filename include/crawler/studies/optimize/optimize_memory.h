// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/optimize_cases.h>
#include <crawler/studies/optimize/optimize_start.h>
#include <crawler/studies/sweep/point_table.h>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /**
   * Starts that have ended, on the rank that keeps them: rows of starts.h5, and those of their evaluations in
   * results.h5 (contracts, doc/optimize.md). Rows are appended as starts end; on resumption, the starts that are
   * complete in both files are read.
   */
  class OptimizeMemory
  {
  public:
    static inline const std::string file = "starts.h5", group = "starts";
    static inline const std::string evaluations_file = "results.h5", evaluations_group = "optimize";

    /// Begins a study in the folder, or resumes the one in it. @p cases and the folder must outlive it. Throws as
    /// begin_or_resume() of a table.
    OptimizeMemory(const OptimizeCases &cases, StudyFolder &folder, const ParameterFile &file);

    /// Returns this start if it has ended, otherwise null.
    const StartResult *
    find(const StartName &start) const;

    /// Writes a start in place of any earlier rows of it. Throws FileError.
    void
    keep(StartResult start);

    /// Keeps only @p starts, in this order, closes the files, and writes them as comma-separated values, too.
    void
    arrange(const std::vector<StartName> &starts);

    const std::vector<StartResult> &
    starts() const
    {
      return starts_;
    }

  private:
    /// Table to which rows are appended.
    struct Rows
    {
      PointTable table;
      std::unique_ptr<RowFile> rows = nullptr;
      unsigned long n               = 0; ///< rows written
    };
    void
    open(Rows &rows, const std::string &ending) const;
    static void
    append(Rows &rows, std::span<const RowFile::Row> more);

    void
    write_all(bool with_room);
    void
    write(const StartResult &start);

    const OptimizeNames &names_;
    const StudyFolder &folder_;
    std::vector<StartResult> starts_; ///< in the order of their rows
    Rows start_rows_, evaluation_rows_;
  };
} // namespace crawler
