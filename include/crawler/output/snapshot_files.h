// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/scenery.h>

namespace crawler
{
  /// Files of one format for all snapshots of a run, a complete animation after each snapshot.
  class SnapshotFiles
  {
  public:
    virtual ~SnapshotFiles() = default;

    /// Adds a frame; @p scenery_changed is the result of Scenery::include(). Throws FileError.
    virtual void
    add(const Frame &frame, const Scenery &scenery, bool scenery_changed) = 0;

    /// Ends the files after the last frame, with the final scenery. Throws FileError.
    virtual void
    end(const Scenery &scenery) = 0;

    /// Exchanges the record of what has been written, as Observer::exchange() does.
    virtual void
    exchange(Archive &archive) = 0;
  };
} // namespace crawler
