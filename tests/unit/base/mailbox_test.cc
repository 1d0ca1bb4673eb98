// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/mailbox.h>
#include <crawler/base/work_queue.h>

#include <gtest/gtest.h>

#include <set>
#include <string>

using namespace crawler;

namespace
{
  /// Long ones with all bytes, each another one.
  std::string
  text_of(const unsigned int rank, const unsigned int number)
  {
    std::string text(100000, static_cast<char>(number));
    return text + std::string(1, '\0') + std::to_string(rank) + "/" + std::to_string(number);
  }
} // namespace

TEST(Mailbox, BringsAllTextsToTheFirstRank)
{
  constexpr unsigned int n = 20;
  std::multiset<std::string> kept, expected;
  const auto keep = [&](const std::string &text) { kept.insert(text); };
  Mailbox mailbox(MPI_COMM_WORLD);
  {
    WorkQueue queue(MPI_COMM_WORLD, 0, [&]() { mailbox.take(keep); });
    for (unsigned int i = 0; i < n; ++i)
      mailbox.send(text_of(rank_of(MPI_COMM_WORLD), i));
  } // rank 0 serves here
  mailbox.take_all(keep);
  for (unsigned int rank = 0; rank < size_of(MPI_COMM_WORLD); ++rank)
    for (unsigned int i = 0; i < n; ++i)
      expected.insert(text_of(rank, i));
  EXPECT_TRUE(kept == (rank_of(MPI_COMM_WORLD) == 0 ? expected : std::multiset<std::string>()));
}

TEST(Mailbox, DropsWhatIsNotTaken)
{
  Mailbox mailbox(MPI_COMM_WORLD);
  mailbox.send("not taken");
}
