// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <optional>

namespace crawler
{
  /**
   * Hands out the numbers 0, 1, ..., size-1 to all ranks, each number once, to whoever asks next. No rank manages: the
   * counters are in the memory of rank 0 and the others change them from outside (one-sided MPI, MPI_Fetch_and_op).
   */
  class WorkQueue
  {
  public:
    /// Collective, and so is the destructor.
    WorkQueue(MPI_Comm communicator, unsigned long size);
    ~WorkQueue();
    WorkQueue(const WorkQueue &) = delete;

    /// The next number, or nothing if none is left.
    std::optional<unsigned long>
    next();

    /// What all ranks together have done.
    struct Done
    {
      unsigned long done, failed; ///< failed: those that were said to be so
    };

    /// Says that so much more is done, usually a number that next() gave, and how much of it failed.
    Done
    done(unsigned long n = 1, unsigned long failed = 0);

    /// Nobody gets a number any more.
    void
    close();

  private:
    enum Counter
    {
      handed_out = 0,
      completed  = 1,
      failures   = 2
    };
    /// Adds to a counter and returns its value before.
    unsigned long
    add(Counter counter, unsigned long increment);

    const unsigned long size_;
    unsigned long *counters_ = nullptr; ///< on rank 0
    MPI_Win window_          = MPI_WIN_NULL;
  };
} // namespace crawler
