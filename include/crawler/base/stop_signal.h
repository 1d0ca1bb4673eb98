// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <csignal>

namespace crawler
{
  /// As long as this lives, SIGINT and SIGTERM (what Slurm sends before the time limit) are noted instead of ending the
  /// process. A second one ends it. What was to happen before is to happen afterwards.
  class StopSignal
  {
  public:
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal &) = delete;

    /// Has one arrived on any rank? (collective)
    bool
    arrived_anywhere(MPI_Comm communicator) const;

  private:
    struct sigaction before_interrupt_, before_termination_;
  };
} // namespace crawler
