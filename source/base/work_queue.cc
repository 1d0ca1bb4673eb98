// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/work_queue.h>

namespace crawler
{
  WorkQueue::WorkQueue(MPI_Comm communicator, const unsigned long size)
    : size_(size)
  {
    const bool first = rank_of(communicator) == 0;
    MPI_Win_allocate(
      first ? 3 * sizeof(unsigned long) : 0, sizeof(unsigned long), MPI_INFO_NULL, communicator, &counters_, &window_);
    MPI_Win_lock_all(0, window_);
    if (first)
    {
      const unsigned long zero = 0;
      for (const int counter : {handed_out, completed, failures})
        MPI_Accumulate(&zero, 1, MPI_UNSIGNED_LONG, /*rank=*/0, counter, 1, MPI_UNSIGNED_LONG, MPI_REPLACE, window_);
      MPI_Win_flush(/*rank=*/0, window_);
    }
    MPI_Barrier(communicator);
  }

  WorkQueue::~WorkQueue()
  {
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
  }

  unsigned long
  WorkQueue::add(const Counter counter, const unsigned long increment)
  {
    unsigned long before = 0;
    MPI_Fetch_and_op(&increment, &before, MPI_UNSIGNED_LONG, /*rank=*/0, counter, MPI_SUM, window_);
    MPI_Win_flush(/*rank=*/0, window_);
    return before;
  }

  std::optional<unsigned long>
  WorkQueue::next()
  {
    const unsigned long number = add(handed_out, 1);
    return number < size_ ? std::optional(number) : std::nullopt;
  }

  WorkQueue::Done
  WorkQueue::done(const unsigned long n, const unsigned long failed)
  {
    const unsigned long before = add(completed, n), failed_before = add(failures, failed);
    return {before + n, failed_before + failed};
  }

  void
  WorkQueue::close()
  {
    add(handed_out, size_);
  }
} // namespace crawler
