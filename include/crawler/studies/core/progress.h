// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>
#include <crawler/studies/core/log.h>

#include <chrono>

namespace crawler
{
  /// A line every few seconds of the pilot runs that choose the numerics.
  class PilotProgress
  {
  public:
    explicit PilotProgress(Log &log);

    /// To be called after every step of a pilot.
    void
    step();

  private:
    using Clock                   = std::chrono::steady_clock;
    static constexpr double every = 3.; ///< [s]
    Log &log_;
    const Clock::time_point start_;
    double next_ = every;
  };

  /// A line at every tenth of the duration.
  class Progress : public Observer
  {
  public:
    Progress(Log &log, const Scene &scene);

    void
    observe(const Snapshot &snapshot) override;

  private:
    Log &log_;
    const double end_time_, length_;
    unsigned int next_tenth_ = 1;
  };
} // namespace crawler
