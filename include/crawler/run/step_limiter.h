// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/step_limits.h>
#include <crawler/run/stress_watch.h>

#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// How long the adaptive steps of a run may be: what is foreseen, and less where the active stress did something
  /// within a step that its ends do not show. Natural units.
  class StepLimiter
  {
  public:
    /// @p limits may be empty; no step is longer than @p longest. An event is what is at least @p least_event [force];
    /// 0: none is looked for.
    StepLimiter(const std::vector<StepLimit> &limits, double longest, const ActiveStress &stress, double least_event);

    std::span<const StepLimit>
    limits() const
    {
      return limits_;
    }
    double
    longest_step(double t) const;

    /// Did the active stress do something within the step [@p from, @p to]? Then its time is limited to shorter ones.
    bool
    passed_over_event(double from, double to);

    /// The active stress jumps.
    void
    restart();

    void
    exchange(Archive &archive)
    {
      archive(limits_);
      if (watch_)
        archive(*watch_);
    }

  private:
    std::vector<StepLimit> limits_;
    std::optional<StressWatch> watch_;
  };
} // namespace crawler
