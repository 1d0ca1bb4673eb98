// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/growing_text.h>
#include <crawler/output/snapshot_files.h>

#include <string>
#include <vector>

namespace crawler
{
  class SnapshotHdf5;

  /**
   * Frames in solution.h5, described by solution.xdmf (body, grip, ground and scale) and line.xdmf (the body as a
   * line with s on the x axis). The datasets have a row for each frame and as many columns as the largest mesh has
   * points; unused ones are NaN, and n_points is the number of used ones. When frames or points exceed the capacity, a
   * larger file replaces it.
   */
  class XdmfFiles : public SnapshotFiles
  {
  public:
    XdmfFiles(const std::filesystem::path &folder, double length, std::size_t n_frames);
    ~XdmfFiles() override;

    void
    add(const Frame &frame, const Scenery &scenery, bool scenery_changed) override;
    void
    end(const Scenery &scenery) override;
    void
    exchange(Archive &archive) override;

  private:
    struct FrameSize
    {
      double time;
      std::size_t n_points;
    };

    /// Makes a file of the new size with all frames so far.
    void
    resize(std::size_t n_frames, std::size_t n_points);
    void
    write_scenery(const Scenery &scenery) const;

    /// Frame @p row as a grid of XDMF.
    std::string
    body_grid(std::size_t row) const;
    std::string
    line_grid(std::size_t row) const;
    void
    rewrite_descriptions();

    const std::filesystem::path path_; ///< of the HDF5 file
    const double length_;
    const std::size_t expected_;              ///< frames
    std::size_t max_frames_, max_points_ = 0; ///< capacity of the file
    std::unique_ptr<SnapshotHdf5> file_;
    std::vector<FrameSize> frames_;
    GrowingText body_, line_; ///< the descriptions
  };
} // namespace crawler
