// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/base/clock.h>
#include <crawler/studies/run/run_stops.h>

using namespace crawler;

TEST(RunStops, AtTheLimitOfTheWallTime)
{
  double time = 100.;
  const ClockOfTest clock([&]() { return time; });
  const StopSignal signal;
  RunStops stops(signal, 10., /*start=*/100., "no/such/file");
  EXPECT_FALSE(stops.arrived_anywhere(MPI_COMM_SELF));
  time = 109.999;
  EXPECT_FALSE(stops.arrived_anywhere(MPI_COMM_SELF));
  time = 110.;
  EXPECT_TRUE(stops.arrived_anywhere(MPI_COMM_SELF));
  EXPECT_STREQ(stops.reason(), "time_limit");
}
