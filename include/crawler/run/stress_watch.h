// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/scene/active_stress.h>

#include <array>

namespace crawler
{
  /// What differs less from what is expected within a step is no event, relative to the largest |m|.
  constexpr double least_event = 0.1;

  /**
   * Looks for events of an active stress that a step has passed over: at times inside of the step that no integrator
   * can foresee it compares m with the cubic polynomial through its neighbours in time. What is smooth enough for a
   * step of an integrator hardly differs from that.
   */
  class StressWatch
  {
  public:
    static constexpr unsigned int n_places = 4, n_inside = 3;

    /// m at places along the body, the ends first, at one time.
    using Values = std::array<double, n_places>;

    /// What differs by less than @p least [force], or than a part of the largest |m| seen, is no event.
    StressWatch(const ActiveStress &stress, double length, double least);

    /// The active stress jumps: m at the last time says nothing about what follows.
    void
    restart()
    {
      end_time_ = -1.;
    }

    /// Is there nothing in the step [@p from, @p to] [time]?
    bool
    is_calm(double from, double to);

    /// At the times inside of the last step.
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
