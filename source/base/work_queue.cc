// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>
#include <crawler/base/communication.h>
#include <crawler/base/work_queue.h>

#include <thread>
#include <utility>

namespace crawler
{
  namespace
  {
    constexpr int owner = 0; // rank that holds the counters
  }

  WorkQueue::WorkQueue(MPI_Comm communicator, const unsigned long size, std::function<void()> besides)
    : communicator_(communicator)
    , size_(size)
    , is_owner_(rank_of(communicator) == owner)
    , has_others_(size_of(communicator) > 1)
    , besides_(std::move(besides))
  {
    MPI_Win_allocate(is_owner_ ? 3 * sizeof(unsigned long) : 0,
                     sizeof(unsigned long),
                     MPI_INFO_NULL,
                     communicator,
                     &counters_,
                     &window_);
    MPI_Win_lock_all(0, window_);
    if (is_owner_)
    {
      const unsigned long zeros[3] = {0, 0, 0};
      MPI_Accumulate(zeros, 3, MPI_UNSIGNED_LONG, owner, handed_out, 3, MPI_UNSIGNED_LONG, MPI_REPLACE, window_);
      MPI_Win_flush(owner, window_);
    }
    MPI_Barrier(communicator);
  }

  WorkQueue::~WorkQueue()
  {
    MPI_Request all_are_here;
    MPI_Ibarrier(communicator_, &all_are_here);
    for (int are_here = 0;;)
    {
      serve();
      MPI_Test(&all_are_here, &are_here, MPI_STATUS_IGNORE);
      if (are_here != 0)
        break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    MPI_Win_unlock_all(window_);
    MPI_Win_free(&window_);
  }

  std::optional<unsigned long>
  WorkQueue::next()
  {
    const unsigned long one = 1;
    unsigned long number    = 0;
    MPI_Fetch_and_op(&one, &number, MPI_UNSIGNED_LONG, owner, handed_out, MPI_SUM, window_);
    MPI_Win_flush(owner, window_);
    return number < size_ ? std::optional(number) : std::nullopt;
  }

  void
  WorkQueue::done(const unsigned long n, const unsigned long failed)
  {
    const unsigned long both[2] = {n, failed};
    MPI_Accumulate(both, 2, MPI_UNSIGNED_LONG, owner, completed, 2, MPI_UNSIGNED_LONG, MPI_SUM, window_);
    MPI_Win_flush_local(owner, window_); // without waiting for arrival
  }

  WorkQueue::Done
  WorkQueue::so_far()
  {
    unsigned long both[2] = {0, 0};
    if (is_owner_)
    {
      for (const int i : {0, 1})
        MPI_Fetch_and_op(nullptr, &both[i], MPI_UNSIGNED_LONG, owner, completed + i, MPI_NO_OP, window_);
      MPI_Win_flush(owner, window_);
    }
    return {both[0], both[1]};
  }

  void
  WorkQueue::serve()
  {
    constexpr double pause = 1e-4; // seconds
    if (!is_owner_ || !has_others_ || now() < served_ + pause)
      return;
    // Any call lets MPI progress; Open MPI looks at TCP in one of eight.
    for (int i = 0; i < 8; ++i)
    {
      int ignored = 0;
      MPI_Iprobe(MPI_ANY_SOURCE, MPI_ANY_TAG, communicator_, &ignored, MPI_STATUS_IGNORE);
    }
    if (besides_)
      besides_();
    served_ = now();
  }

  void
  WorkQueue::close()
  {
    MPI_Accumulate(&size_, 1, MPI_UNSIGNED_LONG, owner, handed_out, 1, MPI_UNSIGNED_LONG, MPI_SUM, window_);
    MPI_Win_flush(owner, window_);
  }
} // namespace crawler
