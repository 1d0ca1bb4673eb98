// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/work_queue.h>

#include <gtest/gtest.h>

#include <vector>

using namespace crawler;

TEST(WorkQueue, HandsOutEachNumberOnce)
{
  for (const unsigned long size : {0ul, 1ul, 2ul, 1000ul}) // fewer than ranks, and more
  {
    WorkQueue queue(MPI_COMM_WORLD, size);
    std::vector<int> taken(size, 0);
    unsigned long done = 0;
    while (const auto number = queue.next())
    {
      ++taken[*number];
      const unsigned long now = queue.done().done;
      EXPECT_GT(now, done);
      EXPECT_LE(now, size);
      done = now;
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
