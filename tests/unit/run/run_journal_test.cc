// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/clock.h>
#include <crawler/run/run_journal.h>

namespace
{
  using namespace crawler;

  /// What was left in the second run goes on, unless it or a run before it was another one.
  TEST(RunJournal, GoesOnWithTheSameRuns)
  {
    std::string left;
    RunJournal journal(0., [&](const std::string &bytes) {
      left = bytes;
      return true;
    });
    EXPECT_FALSE(journal.begin("pilot"));
    journal.end(SimulationResult());
    EXPECT_FALSE(journal.begin("run"));
    journal.keep("half of it");
    for (const auto &[pilot, run] : {std::pair("pilot", "run"), {"pilot", "another run"}, {"another pilot", "run"}})
    {
      RunJournal now(0., {});
      EXPECT_FALSE(now.knows_next());
      now.load(left);
      EXPECT_TRUE(now.knows_next());
      EXPECT_EQ(now.begin(pilot).has_value(), pilot == std::string("pilot"));
      if (pilot != std::string("pilot"))
        now.end(SimulationResult());
      EXPECT_EQ(now.knows_next(), pilot == std::string("pilot"));
      EXPECT_FALSE(now.begin(run));
      EXPECT_EQ(now.state() != nullptr, pilot + std::string(run) == "pilotrun") << pilot << ", " << run;
    }
  }

  /// There is no folder yet: the first state is due as soon as there is one.
  TEST(RunJournal, WhatIsNotKeptDoesNotCount)
  {
    double time = 0.;
    const ClockOfTest clock([&]() { return time; });
    bool has_folder = false;
    RunJournal journal(0., [&](const std::string &) {
      time += 10.;
      return has_folder;
    });
    EXPECT_FALSE(journal.begin("pilot"));
    journal.end(SimulationResult());
    EXPECT_FALSE(journal.was_written());
    EXPECT_TRUE(journal.is_due());
    has_folder = true;
    EXPECT_FALSE(journal.begin("run"));
    journal.keep("state");
    EXPECT_TRUE(journal.was_written());
    EXPECT_FALSE(journal.is_due());
  }

  TEST(RunJournal, WritesStatesAtItsIntervalAndNotTooOften)
  {
    double time = 0.;
    const ClockOfTest clock([&]() { return time; });
    RunJournal journal(10., [&](const std::string &) {
      time += 1.;
      return true;
    }); // a state costs a second
    EXPECT_FALSE(journal.begin("run"));
    time = 9.;
    EXPECT_FALSE(journal.is_due());
    time = 10.;
    EXPECT_TRUE(journal.is_due());
    journal.keep("state"); // until 11
    time = 25.;
    EXPECT_FALSE(journal.is_due()); // 5 % of the time at most
    time = 31.;
    EXPECT_TRUE(journal.is_due());
  }
} // namespace
