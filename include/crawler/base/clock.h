// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>

namespace crawler
{
  /// Seconds of a monotonic clock, for differences. All time limits and printed times come from it.
  double
  now();

  /// Seconds since its construction.
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

  /// Replaces now() during its lifetime, for tests of time limits.
  class ClockOfTest
  {
  public:
    explicit ClockOfTest(std::function<double()> clock);
    ~ClockOfTest();
    ClockOfTest(const ClockOfTest &) = delete;
  };
} // namespace crawler
