// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/studies/run/run_progress.h>

#include <fmt/format.h>

#include <algorithm>

namespace crawler
{
  RunProgress::RunProgress(Log &log, const Scene &scene)
    : log_(log)
    , end_time_(scene.end_time)
    , length_(scene.body.length)
    , bar_(log)
  {
  }

  void
  RunProgress::observe(const Snapshot &snapshot)
  {
    if (!snapshot.is_step_end || snapshot.step.number == 0)
      return;
    const Step &step          = snapshot.step;
    const StretchRange &range = snapshot.stretch;
    const double done = step.time / end_time_, displacement = snapshot.integrals.displacement / length_;
    if (bar_.is_due())
      bar_.show(std::min(done, 1.),
                fmt::format("t = {:.4g}  displacement {:.6g}  stretch {:.3g} to {:.3g}",
                            step.time,
                            displacement,
                            range.min.value,
                            range.max.value));
    if (10. * done < next_tenth_)
      return;
    while (next_tenth_ <= 10. * done)
      ++next_tenth_;
    log_.progress(
      fmt::format("  {:3.0f} %  t = {:<10.4g} step {:<6} size {:<9.3g} displacement {:<14.8g} stretch {:.3g} to {:.3g}",
                  100. * done,
                  step.time,
                  step.number,
                  step.size,
                  displacement,
                  range.min.value,
                  range.max.value));
  }
} // namespace crawler
