// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/process.h>

using namespace crawler;

TEST(Process, ItsStatusAndErrorsComeBack)
{
  const ProgramEnd end = run_program({"sh", "-c", "echo hidden; echo \"$1\" >&2; exit 3", "sh", "$(two) words"}, false);
  EXPECT_TRUE(end.started);
  EXPECT_EQ(end.status, 3);
  EXPECT_EQ(end.errors, "$(two) words\n"); // no shell has read the argument
}

TEST(Process, ManyErrorsDoNotBlockIt)
{
  const ProgramEnd end = run_program({"sh", "-c", "head -c 1000000 /dev/zero >&2"}, false);
  EXPECT_EQ(end.status, 0);
  EXPECT_EQ(end.errors.size(), 1000000u); // far more than a pipe holds
}

TEST(Process, ASignalOrAMissingProgramIsNoStatus)
{
  EXPECT_EQ(run_program({"sh", "-c", "kill -9 $$"}, false).status, -1);
  EXPECT_FALSE(run_program({"no-such-program-here"}, false).started);
}

TEST(Process, SignalsThatStopThisOneGoToIt)
{
  const auto end_of = [](const std::string &name) {
    return run_program(
      {"sh", "-c", "trap 'exit 5' " + name + "; kill -" + name + " $PPID; while :; do sleep 0.01; done"}, false);
  };
  const auto before = std::signal(SIGINT, SIG_DFL); // what runs in the background ignores it
  for (const std::string name : {"INT", "TERM", "USR1"})
    EXPECT_EQ(end_of(name).status, 5) << name;
  std::signal(SIGINT, before);
}

TEST(Process, SignalsThatAreIgnoredStopNeither)
{
  const auto before = std::signal(SIGTERM, SIG_IGN);
  EXPECT_EQ(run_program({"sh", "-c", "kill -TERM $PPID; kill -TERM $$; exit 3"}, false).status, 3);
  EXPECT_EQ(std::signal(SIGTERM, before), SIG_IGN);
}

TEST(Process, ACopyTriesWhatMayCrashOrNeverEnd)
{
  EXPECT_TRUE(comes_to_an_end([]() {}, 1));
  EXPECT_TRUE(comes_to_an_end([]() { throw std::runtime_error("in order"); }, 1));
  EXPECT_FALSE(comes_to_an_end([]() { std::abort(); }, 1));
  EXPECT_FALSE(comes_to_an_end(
    []() {
      const volatile bool goes_on = true;
      while (goes_on) // and yields to nobody: turns of others would be no time of its own
        ;
    },
    1));
  bool is_changed = false;
  comes_to_an_end([&]() { is_changed = true; }, 1);
  EXPECT_FALSE(is_changed) << "the copy has memory of its own";
}
