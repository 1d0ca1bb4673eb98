// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/clock.h>
#include <crawler/base/exceptions.h>
#include <crawler/run/run_journal.h>

namespace
{
  using namespace crawler;

  SimulationResult
  a_result(const double displacement)
  {
    SimulationResult result;
    result.time.status  = Status::finished;
    result.displacement = displacement;
    return result;
  }

  /// What is written when the first run has ended and the second one is stopped.
  std::string
  left_in_the_second_run()
  {
    std::string written;
    RunJournal journal(1e9, [&](const std::string &bytes) {
      written = bytes;
      return true;
    });
    EXPECT_FALSE(journal.begin("pilot"));
    journal.end(a_result(0.25));
    EXPECT_FALSE(journal.begin("run"));
    EXPECT_EQ(journal.state(), nullptr);
    EXPECT_FALSE(journal.is_due());
    journal.keep("half of it");
    journal.close();
    const std::string last = written;
    journal.end(a_result(0.1)); // what a stopped run gives is no result
    journal.keep("nothing");
    journal.write();
    EXPECT_EQ(written, last);
    return written;
  }

  TEST(RunJournal, GoesOnWhereItWasLeft)
  {
    RunJournal journal(0., {});
    journal.load(left_in_the_second_run());
    const auto pilot = journal.begin("pilot");
    ASSERT_TRUE(pilot);
    EXPECT_EQ(pilot->displacement, 0.25);
    EXPECT_EQ(pilot->time.status, Status::finished);
    EXPECT_FALSE(journal.begin("run"));
    ASSERT_NE(journal.state(), nullptr);
    EXPECT_EQ(*journal.state(), "half of it");
    journal.end(a_result(0.5));
    EXPECT_FALSE(journal.begin("next"));
    EXPECT_EQ(journal.state(), nullptr);
  }

  TEST(RunJournal, ForgetsWhatBelongsToOtherRuns)
  {
    RunJournal first(0., {}), second(0., {});
    first.load(left_in_the_second_run());
    EXPECT_FALSE(first.begin("another pilot"));
    EXPECT_EQ(first.state(), nullptr);
    first.end(a_result(1.));
    EXPECT_FALSE(first.begin("run"));
    EXPECT_EQ(first.state(), nullptr);

    second.load(left_in_the_second_run());
    EXPECT_TRUE(second.begin("pilot"));
    EXPECT_FALSE(second.begin("another run"));
    EXPECT_EQ(second.state(), nullptr);
  }

  TEST(RunJournal, RefusesOtherBytes)
  {
    RunJournal journal(0., {});
    EXPECT_THROW(journal.load(left_in_the_second_run().substr(1)), FileError);
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
    journal.end(a_result(0.25));
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
