// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

namespace crawler
{
  /// As long as this lives, SIGINT and SIGTERM (what Slurm sends before the time limit) are noted instead of ending the
  /// process. A second one ends it.
  class StopSignal
  {
  public:
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal &) = delete;

    /// Has one arrived on any rank? (collective)
    bool
    arrived_anywhere(MPI_Comm communicator) const;
  };
} // namespace crawler
