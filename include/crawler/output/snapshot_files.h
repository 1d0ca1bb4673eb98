// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/scenery.h>

namespace crawler
{
  /// Files of a format for all snapshots of a run, a complete animation after each of them.
  class SnapshotFiles
  {
  public:
    virtual ~SnapshotFiles() = default;

    /// Adds a frame; @p scenery_changed is what Scenery::include() said of it. Throws FileError.
    virtual void
    add(const Frame &frame, const Scenery &scenery, bool scenery_changed) = 0;

    /// After the last frame, with the final scenery. Throws FileError.
    virtual void
    end(const Scenery &scenery) = 0;

    /// What has been written, as for Observer::exchange().
    virtual void
    exchange(Archive &archive) = 0;
  };
} // namespace crawler
