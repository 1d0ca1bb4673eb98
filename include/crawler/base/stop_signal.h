// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <csignal>

namespace crawler
{
  /// Notes SIGINT, SIGTERM (sent by Slurm at the time limit) and SIGUSR1 (which it can be asked to send before) during
  /// its lifetime; they do not end the process, but a second one does. The previous handlers are restored afterwards.
  class StopSignal
  {
  public:
    StopSignal();
    ~StopSignal();
    StopSignal(const StopSignal &) = delete;

    /// Returns whether a signal has arrived on this rank.
    bool
    arrived() const;

    /// Returns whether a signal has arrived on any rank (collective).
    bool
    arrived_anywhere(MPI_Comm communicator) const;

  private:
    static constexpr int numbers[] = {SIGINT, SIGTERM, SIGUSR1};
    struct sigaction before_[3];
  };
} // namespace crawler
