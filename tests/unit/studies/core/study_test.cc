// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/base/clock.h>
#include <crawler/studies/core/study.h>

using namespace crawler;

TEST(StudyClock, IsOverAtTheTimeLimit)
{
  double time = 100.;
  const ClockOfTest clock_of_test([&]() { return time; });
  StudyClock clock;
  clock.set_limit(10., "a limit");
  clock.set_stop_file("no/such/file");
  EXPECT_FALSE(clock.is_over());
  time = 109.999;
  EXPECT_FALSE(clock.is_over());
  time = 110.;
  EXPECT_TRUE(clock.is_over());
  EXPECT_EQ(clock.reason(), "time_limit");
}
