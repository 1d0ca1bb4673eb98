// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/step_limits.h>
#include <crawler/run/stress_watch.h>

#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Limits of the adaptive steps of a run: those foreseen, and less where the active stress has events within a step
  /// that its ends do not show. Natural units.
  class StepLimiter
  {
  public:
    /// @p limits may be empty; no step is longer than @p longest. Events are changes of at least @p min_event
    /// [force]; 0: events are not looked for.
    StepLimiter(const std::vector<StepLimit> &limits, double longest, const ActiveStress &stress, double min_event);

    std::span<const StepLimit>
    limits() const
    {
      return limits_;
    }
    double
    longest_step(double t) const;

    /// True if the active stress had an event within the step [@p from, @p to]; then shorter steps are set there.
    bool
    passed_over_event(double from, double to);

    /// Restarts after a jump of the active stress.
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
