// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/communication.h>
#include <crawler/base/work_queue.h>

#include <unistd.h>

using namespace crawler;

namespace
{
  /// How often a process has given up the processor by itself.
  unsigned long
  times_asleep(const long process)
  {
    std::ifstream status("/proc/" + std::to_string(process) + "/status");
    for (std::string word; status >> word;)
      if (unsigned long n = 0; word == "voluntary_ctxt_switches:" && status >> n)
        return n;
    throw std::runtime_error("no process " + std::to_string(process));
  }
} // namespace

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
  // Rank 1 is late: it comes when rank 0 has gone to sleep many times, which one that spins never does.
  constexpr unsigned long many = 20;
  long process                 = getpid();
  MPI_Bcast(&process, 1, MPI_LONG, 0, MPI_COMM_WORLD);
  std::optional<WorkQueue> queue(std::in_place, MPI_COMM_WORLD, 1);
  if (rank_of(MPI_COMM_WORLD) == 1)
    for (const unsigned long before = times_asleep(process); times_asleep(process) < before + many;)
      std::this_thread::yield();
  queue.reset();
}

TEST(WorkQueue, TakesWhatOtherRanksSendWhileItServes)
{
  const unsigned int n_ranks = size_of(MPI_COMM_WORLD), rank = rank_of(MPI_COMM_WORLD);
  const auto text_of = [](const unsigned int sender, const unsigned int i) { // long ones with all bytes
    return std::string(100000, static_cast<char>(i)) + std::string(1, '\0') + std::to_string(sender);
  };
  constexpr unsigned int n = 20;
  std::multiset<std::string> kept, expected;
  const auto take = [&]() { take_from_others(MPI_COMM_WORLD, [&](const std::string &text) { kept.insert(text); }); };
  {
    WorkQueue queue(MPI_COMM_WORLD, 0, take);
    for (unsigned int i = 0; rank > 0 && i < n; ++i)
      send_to_first_rank(text_of(rank, i), MPI_COMM_WORLD);
  }
  for (unsigned int sender = 1; rank == 0 && sender < n_ranks; ++sender)
    for (unsigned int i = 0; i < n; ++i)
      expected.insert(text_of(sender, i));
  EXPECT_TRUE(kept == expected);
}
