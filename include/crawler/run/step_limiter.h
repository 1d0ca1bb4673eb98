// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/base/step_limits.h>
#include <crawler/scene/active_stress.h>

#include <array>
#include <optional>
#include <span>
#include <vector>

namespace crawler
{
  /// Smallest deviation within a step from the expected stress that is an event, relative to the largest |m|.
  constexpr double min_event = 0.1;

  /**
   * Watch for events of an active stress that a step has passed over: at times inside the step that no integrator can
   * foresee it compares m with the cubic polynomial through its neighbours in time. A stress smooth enough for a step
   * of an integrator hardly differs from that.
   */
  class StressWatch
  {
  public:
    static constexpr unsigned int n_places = 4, n_inside = 3;

    /// Values of m at places along the body, of length 1, the ends first, at one time.
    using Values = std::array<double, n_places>;

    /// Deviations below @p least [force], or below a part of the largest |m| seen, are no events.
    StressWatch(const ActiveStress &stress, double least);

    /// Restarts after a jump of the active stress: m at the last time does not predict what follows.
    void
    restart()
    {
      end_time_ = -1.;
    }

    /// True if the step [@p from, @p to] [time] has no event.
    bool
    is_calm(double from, double to);

    /// Values at the times inside the last step.
    const std::array<Values, n_inside> &
    inside() const
    {
      return inside_;
    }

    void
    exchange(Archive &archive)
    {
      archive(largest_, end_time_, random_, end_, inside_);
    }

  private:
    std::unique_ptr<ActiveStressAtPoints> stress_;
    double least_, largest_ = 0.;
    double end_time_ = -1., random_ = 0.; ///< end of the last step; the latest of a sequence that fills [0, 1)
    Values end_{};
    std::array<Values, n_inside> inside_{};
  };

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
