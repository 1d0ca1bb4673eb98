// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <functional>
#include <optional>

namespace crawler
{
  /**
   * Hands out the numbers 0, 1, ..., size-1 to all ranks, each number once, on request. No rank manages: the
   * counters are in the memory of rank 0, and the others change them by one-sided MPI (MPI_Fetch_and_op). Within a node
   * and over networks with atomic operations rank 0 takes no part. Elsewhere (TCP) requests wait until rank 0 calls
   * MPI: hence serve().
   */
  class WorkQueue
  {
  public:
    /// Creates the queue (collective, as is the destructor, which waits for the other ranks, asleep rather than
    /// spinning). @p besides is called by rank 0 whenever it serves, also in the destructor; it must not throw.
    WorkQueue(MPI_Comm communicator, unsigned long size, std::function<void()> besides = {});
    ~WorkQueue();
    WorkQueue(const WorkQueue &) = delete;

    /// Returns the next number, or nothing if none is left.
    std::optional<unsigned long>
    next();

    /// Reports @p n items done, usually one number from next(), of which @p failed failed.
    void
    done(unsigned long n = 1, unsigned long failed = 0);

    /// Totals of all ranks.
    struct Done
    {
      unsigned long done, failed; ///< `failed` counts those reported as failed
    };

    /// Returns the totals on rank 0, zeros on the others.
    Done
    so_far();

    /// Serves requests; to be called now and then while computing (at every step: it mostly returns at once).
    void
    serve();

    /// Closes the queue: no number is given any more.
    void
    close();

  private:
    enum Counter
    {
      handed_out = 0,
      completed  = 1,
      failures   = 2
    };

    const MPI_Comm communicator_;
    const unsigned long size_;
    const bool is_owner_, has_others_;
    const std::function<void()> besides_;
    double served_           = 0.;      ///< time of the last serve()
    unsigned long *counters_ = nullptr; ///< on rank 0
    MPI_Win window_          = MPI_WIN_NULL;
  };
} // namespace crawler
