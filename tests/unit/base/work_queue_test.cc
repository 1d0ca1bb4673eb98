// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/work_queue.h>

#include <gtest/gtest.h>

#include <ctime>
#include <thread>
#include <vector>

using namespace crawler;

TEST(WorkQueue, HandsOutEachNumberOnce)
{
  for (const unsigned long size : {0ul, 1ul, 2ul, 1000ul}) // fewer than ranks, and more
  {
    WorkQueue queue(MPI_COMM_WORLD, size);
    std::vector<int> taken(size, 0);
    while (const auto number = queue.next())
    {
      ++taken[*number];
      queue.done();
    }
    EXPECT_FALSE(queue.next());
    MPI_Allreduce(MPI_IN_PLACE, taken.data(), static_cast<int>(size), MPI_INT, MPI_SUM, MPI_COMM_WORLD);
    EXPECT_EQ(taken, std::vector<int>(size, 1));
  }
}

TEST(WorkQueue, IsClosedForAllRanks)
{
  WorkQueue queue(MPI_COMM_WORLD, 100);
  queue.close();
  EXPECT_FALSE(queue.next());
}

TEST(WorkQueue, CountsWhatAllRanksHaveDone)
{
  const unsigned long n = size_of(MPI_COMM_WORLD), rank = rank_of(MPI_COMM_WORLD);
  WorkQueue queue(MPI_COMM_WORLD, 1000);
  queue.done(rank, 1);
  if (rank == 0)
  {
    // Rank 0 computes, as far as the others can see: they get through all the same.
    unsigned long before = 0;
    WorkQueue::Done all  = queue.so_far();
    for (; all.failed < n; all = queue.so_far())
    {
      EXPECT_GE(all.done, before);
      before = all.done;
      queue.serve();
    }
    EXPECT_EQ(all.done, n * (n - 1) / 2);
    EXPECT_EQ(all.failed, n);
  }
  else
    EXPECT_EQ(queue.so_far().done, 0u) << "only rank 0 reports";
}

TEST(WorkQueue, WaitsAsleep)
{
  const auto processor_seconds = []() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; };
  std::optional<WorkQueue> queue(std::in_place, MPI_COMM_WORLD, 1);
  if (rank_of(MPI_COMM_WORLD) == 1)
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
  const double before = processor_seconds();
  queue.reset(); // the others wait half a second for rank 1, if there is one
  EXPECT_LT(processor_seconds() - before, 0.25);
}
