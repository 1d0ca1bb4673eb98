// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>

namespace crawler
{
  /// Seconds of a clock that only goes forward, for differences. Every limit of time and every time that is printed
  /// comes from it.
  double
  now();

  /// Seconds since it was made.
  class Stopwatch
  {
  public:
    double
    seconds() const
    {
      return now() - start_;
    }

  private:
    double start_ = now();
  };

  /// Another clock in place of now(), for tests of limits of time, as long as this lives.
  class ClockOfTest
  {
  public:
    explicit ClockOfTest(std::function<double()> clock);
    ~ClockOfTest();
    ClockOfTest(const ClockOfTest &) = delete;
  };
} // namespace crawler
