// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/scene/active_stress.h>

#include <array>

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

    /// Values of m at places along the body, the ends first, at one time.
    using Values = std::array<double, n_places>;

    /// Deviations below @p least [force], or below a part of the largest |m| seen, are no events.
    StressWatch(const ActiveStress &stress, double length, double least);

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
} // namespace crawler
