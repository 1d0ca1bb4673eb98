// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/optimize_memory.h>

#include <functional>
#include <vector>

namespace crawler
{
  /// Searches of an optimisation: true unless they were interrupted, and their starts in the order of the cases.
  struct SearchesMade
  {
    bool are_whole;
    std::vector<StartName> starts;
  };

  /**
   * Makes the searches that have not ended yet, which the ranks share: from all starts, then from the best gaits of
   * neighbours as long as these are better (collective). Rank 0 keeps their results, in its @p memory. Throws
   * FileError, on all ranks.
   */
  SearchesMade
  make_searches(MPI_Comm communicator,
                OptimizeCases &cases,
                OptimizeMemory *memory,
                const StudyFolder &folder,
                std::function<bool()> interrupted);
} // namespace crawler
