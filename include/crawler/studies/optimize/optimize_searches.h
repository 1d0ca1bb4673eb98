// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/studies/core/crash_file.h>
#include <crawler/studies/optimize/optimize_cases.h>
#include <crawler/studies/optimize/optimize_results.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// Start of a case: its own, or the best gait of a neighbour of the case.
  struct Part : StartName
  {
    std::vector<double> x = {}; ///< gait of the neighbour

    void
    exchange(Archive &archive)
    {
      archive(number_of_case, start, neighbour, x);
    }
  };

  /**
   * Searches of an optimisation, which the ranks share (collective, except where rank 0 is named). Rank 0 keeps their
   * results.
   */
  class OptimizeSearches
  {
  public:
    /// @p memory is that of rank 0.
    OptimizeSearches(MPI_Comm communicator,
                     OptimizeCases &cases,
                     std::unique_ptr<OptimizeMemory> memory,
                     const std::filesystem::path &folder,
                     std::function<bool()> interrupted,
                     Log &log);

    /// Runs the searches that have not ended yet: from all starts, then from the best gaits of neighbours as long as
    /// these are better. Returns false if it was interrupted. Throws FileError, on all ranks.
    bool
    go_on();

    /// Results in the order of the cases, which the files have afterwards, too (rank 0).
    OptimizeResults
    results();

    /// Number of searches that began with the gait of a neighbour.
    std::size_t
    n_from_neighbours() const;

  private:
    bool
    search_all(const std::vector<Part> &some);
    std::vector<StartName>
    names_in_order() const;
    OptimizeResults
    results_so_far() const;
    std::vector<Part>
    parts_from_neighbours();
    void
    keep(StartResult start);

    const MPI_Comm communicator_;
    OptimizeCases &cases_;
    const std::unique_ptr<OptimizeMemory> memory_;
    const std::function<bool()> interrupted_;
    Log &log_;
    std::vector<Part> parts_;
    SearchState state_;
    CrashNote note_;
    std::string problem_; ///< problem with the files
  };
} // namespace crawler
