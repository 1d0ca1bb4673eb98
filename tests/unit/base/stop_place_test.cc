// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/base/stop_place.h>

using namespace crawler;

TEST(StopPlace, HasANumberASignalAndARank)
{
  const StopWish whole = stop_wish("row:17:KILL:1");
  EXPECT_EQ(whole.place, "row");
  EXPECT_EQ(whole.number, 17u);
  EXPECT_EQ(whole.signal, SIGKILL);
  EXPECT_EQ(whole.rank, 1);

  const StopWish first = stop_wish("pilot:INT");
  EXPECT_EQ(first.place, "pilot");
  EXPECT_EQ(first.number, 1u);
  EXPECT_EQ(first.signal, SIGINT);
  EXPECT_EQ(first.rank, -1);

  const StopWish file = stop_wish("write:results.h5:3:TERM");
  EXPECT_EQ(file.place, "write:results.h5");
  EXPECT_EQ(file.number, 3u);
  EXPECT_EQ(stop_wish("write:summary.json:STOP:0").rank, 0);
}

TEST(StopPlace, OthersAreRefused)
{
  for (const char *text :
       {"", "KILL", "row", "rows:KILL", "row:KILLED", "row:0:KILL", "row:-1:KILL", "row:1:2:KILL", "write:KILL"})
    EXPECT_THROW(stop_wish(text), InputError) << text;
}
