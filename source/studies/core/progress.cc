// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/core/progress.h>

#include <fmt/format.h>

namespace crawler
{
  Progress::Progress(Log &log, const Scene &scene)
    : log_(log)
    , end_time_(scene.end_time)
    , length_(scene.body.length)
  {
  }

  PilotProgress::PilotProgress(Log &log)
    : log_(log)
    , start_(Clock::now())
  {
  }

  void
  PilotProgress::step()
  {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    if (seconds < next_)
      return;
    next_ += every;
    log_.line(fmt::format("  pilot runs choose mesh and time steps ... {:.0f} s", seconds));
  }

  void
  Progress::observe(const Snapshot &snapshot)
  {
    const double done = 10. * snapshot.step.time / end_time_;
    if (!snapshot.is_step_end || done < next_tenth_ || snapshot.step.number == 0)
      return;
    while (next_tenth_ <= done)
      ++next_tenth_;
    log_.line(
      fmt::format("  {:3.0f} %  t = {:<10.4g} step {:<6} size {:<9.3g} displacement {:<14.8g} stretch {:.3g} to {:.3g}",
                  10. * done,
                  snapshot.step.time,
                  snapshot.step.number,
                  snapshot.step.size,
                  snapshot.integrals.displacement / length_,
                  snapshot.stretch.min.value,
                  snapshot.stretch.max.value));
  }
} // namespace crawler
