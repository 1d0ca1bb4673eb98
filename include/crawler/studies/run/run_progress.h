// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/observer.h>
#include <crawler/scene/scene.h>
#include <crawler/studies/core/progress.h>

namespace crawler
{
  /// Progress of a run: a bar, or a line at every tenth of the duration.
  class RunProgress : public Observer
  {
  public:
    RunProgress(Log &log, const Scene &scene);

    void
    observe(const Snapshot &snapshot) override;

  private:
    Log &log_;
    const double end_time_, length_;
    ProgressBar bar_;
    unsigned int next_tenth_ = 1;
  };
} // namespace crawler
