// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/clock.h>

#include <chrono>
#include <utility>

namespace crawler
{
  namespace
  {
    std::function<double()> clock_of_test;
  }

  double
  now()
  {
    if (clock_of_test)
      return clock_of_test();
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
  }

  ClockOfTest::ClockOfTest(std::function<double()> clock)
  {
    clock_of_test = std::move(clock);
  }

  ClockOfTest::~ClockOfTest()
  {
    clock_of_test = nullptr;
  }
} // namespace crawler
