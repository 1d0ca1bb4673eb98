// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/base/clock.h>
#include <crawler/studies/run/run_stops.h>

using namespace crawler;

namespace
{
  const std::filesystem::path no_file = "no/such/file";
}

TEST(RunStops, AtTheLimitOfTheWallTime)
{
  double time = 100.;
  const ClockOfTest clock([&]() { return time; });
  const StopSignal signal;
  RunStops stops(signal, 10., /*start=*/100., no_file);
  EXPECT_FALSE(stops.arrived_anywhere(MPI_COMM_SELF));
  time = 109.999;
  EXPECT_FALSE(stops.arrived_anywhere(MPI_COMM_SELF));
  time = 110.;
  EXPECT_TRUE(stops.arrived_anywhere(MPI_COMM_SELF));
  EXPECT_STREQ(stops.reason(), "time_limit");
}

TEST(RunStops, AtASignal)
{
  const StopSignal signal;
  RunStops stops(signal, {}, now(), no_file);
  EXPECT_FALSE(stops.arrived_anywhere(MPI_COMM_SELF));
  std::raise(SIGTERM);
  EXPECT_TRUE(stops.arrived_anywhere(MPI_COMM_SELF));
  EXPECT_STREQ(stops.reason(), "signal");
}

TEST(RunStops, AtAFileForWhichItLooksNowAndThen)
{
  double time = 0.;
  const ClockOfTest clock([&]() { return time; });
  const std::filesystem::path file = std::filesystem::temp_directory_path() / "crawler_run_stops_test";
  std::ofstream(file) << "stop";
  const StopSignal signal;
  RunStops stops(signal, {}, time, file);
  EXPECT_FALSE(stops.arrived_anywhere(MPI_COMM_SELF)); // files are dear to look for
  time = 1.;
  EXPECT_TRUE(stops.arrived_anywhere(MPI_COMM_SELF));
  EXPECT_STREQ(stops.reason(), "stop_file");
  std::filesystem::remove(file);
}
