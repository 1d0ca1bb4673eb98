// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/log.h>
#include <crawler/observers/observer.h>

namespace crawler
{
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
