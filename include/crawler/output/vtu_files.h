// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/growing_text.h>
#include <crawler/output/snapshot_files.h>

namespace crawler
{
  /// Files solution.pvd (body, ground, grip and scale of each frame) and line.pvd (the body as a line with s on the x
  /// axis). Both name files in solution/.
  class VtuFiles : public SnapshotFiles
  {
  public:
    VtuFiles(const std::filesystem::path &folder, double length);

    void
    add(const Frame &frame, const Scenery &scenery, bool scenery_changed) override;
    void
    end(const Scenery &scenery) override;
    void
    exchange(Archive &archive) override;

  private:
    void
    write_scenery(const Scenery &scenery) const;

    const std::filesystem::path folder_;
    const double length_;
    unsigned int n_frames_ = 0;
    GrowingText body_, line_; ///< the lists of files
  };
} // namespace crawler
