// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <mpi.h>

#include <functional>
#include <optional>

namespace crawler
{
  /**
   * Hands out the numbers 0, 1, ..., size-1 to all ranks, each number once, to whoever asks next. No rank manages: the
   * counters are in the memory of rank 0 and the others change them from outside (one-sided MPI, MPI_Fetch_and_op).
   * Within a node and over networks with atomic operations they do so without rank 0. Elsewhere (TCP) their requests
   * wait until rank 0 calls MPI, which serve() is for.
   */
  class WorkQueue
  {
  public:
    /// Collective, and so is the destructor: it waits for the other ranks, asleep rather than spinning.
    /// @p besides is what rank 0 does whenever it serves, the destructor included; it must not throw.
    WorkQueue(MPI_Comm communicator, unsigned long size, std::function<void()> besides = {});
    ~WorkQueue();
    WorkQueue(const WorkQueue &) = delete;

    /// The next number, or nothing if none is left.
    std::optional<unsigned long>
    next();

    /// Says that so much more is done, usually a number that next() gave, and how much of it failed.
    void
    done(unsigned long n = 1, unsigned long failed = 0);

    /// What all ranks together have done.
    struct Done
    {
      unsigned long done, failed; ///< failed: those that were said to be so
    };

    /// On rank 0, which reports it; zeros on the others.
    Done
    so_far();

    /// To be called now and then while computing (at every step: it mostly returns at once).
    void
    serve();

    /// No number is given any more.
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
    double served_           = 0.;      ///< when
    unsigned long *counters_ = nullptr; ///< on rank 0
    MPI_Win window_          = MPI_WIN_NULL;
  };
} // namespace crawler
