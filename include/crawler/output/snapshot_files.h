// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/scenery.h>

#include <filesystem>
#include <memory>

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

  /// Makes files solution.pvd (body, ground, grip and scale of each frame) and line.pvd (the body as a line with s on
  /// the x axis). Both name files in solution/.
  std::unique_ptr<SnapshotFiles>
  vtu_files(const std::filesystem::path &folder, double length);

  /// Makes solution.h5, described by solution.xdmf and line.xdmf as above, for @p n_frames expected frames.
  std::unique_ptr<SnapshotFiles>
  xdmf_files(const std::filesystem::path &folder, double length, std::size_t n_frames);
} // namespace crawler
