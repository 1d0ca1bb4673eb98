// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <csignal>

namespace crawler
{
  /// As long as this lives, SIGINT, SIGTERM (what Slurm sends at the time limit) and SIGUSR1 (what it can be asked to
  /// send before) are noted instead of ending the process. A second one ends it. What was to happen before is to happen
  /// afterwards.
  class StopSignal
  {
  public:
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal &) = delete;

    /// Has one arrived on this rank?
    bool
    arrived() const;

    /// Has one arrived on any rank? (collective)
    bool
    arrived_anywhere(MPI_Comm communicator) const;

  private:
    static constexpr int numbers[] = {SIGINT, SIGTERM, SIGUSR1};
    struct sigaction before_[3];
  };
} // namespace crawler
