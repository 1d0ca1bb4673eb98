// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../../support/test.h"

#include <crawler/base/clock.h>
#include <crawler/studies/core/output_folder.h>
#include <crawler/studies/core/study.h>

#include <fstream>

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

/// Names that only resemble those of the program's own runs are names of others.
TEST(StudyFolder, RemovesItsOwnRunsAlone)
{
  const std::filesystem::path folder = testing::TempDir() + "own_runs";
  std::filesystem::remove_all(folder);
  for (const char *name : {"best", "best-2", "best2", "best-2b"})
  {
    std::filesystem::create_directories(folder / name);
    std::ofstream(folder / name / "summary.json") << "{}";
  }
  remove_runs(folder, "best(-[0-9]+)?");
  std::set<std::string> left;
  for (const auto &entry : std::filesystem::directory_iterator(folder))
    left.insert(entry.path().filename());
  EXPECT_EQ(left, (std::set<std::string>{"best2", "best-2b"}));
  EXPECT_TRUE(std::filesystem::exists(folder / "best2" / "summary.json"));
  std::filesystem::remove_all(folder);
}
