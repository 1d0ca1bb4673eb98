// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/base/stop_place.h>

using namespace crawler;

TEST(StopPlace, OthersAreRefused)
{
  for (const char *text :
       {"", "KILL", "row", "rows:KILL", "row:KILLED", "row:0:KILL", "row:-1:KILL", "row:1:2:KILL", "write:KILL"})
    EXPECT_THROW(stop_wish(text), InputError) << text;
}
