// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/field_sampler.h>
#include <crawler/output/output_parameters.h>
#include <crawler/output/snapshot_files.h>

#include <filesystem>
#include <memory>
#include <string>

namespace crawler
{
  /// The file of a format to be opened in ParaView.
  std::string
  animation_file(SnapshotFormat format);

  /**
   * Writes the snapshots of a run, or given frames. The fields are sampled at q + 1 equidistant points of each cell of
   * degree q; the stretch is not averaged between cells. Rank 0 writes.
   */
  class SnapshotWriter : public Observer
  {
  public:
    /// Takes the length L [length] and the expected number of frames @p n_frames.
    SnapshotWriter(SnapshotFormat format, const std::filesystem::path &folder, double length, std::size_t n_frames);

    void
    observe(const Snapshot &snapshot) override;
    void
    show(const StateWithoutMesh &state) override
    {
      if (state.pictures.is_snapshot)
        write(state.frame);
    }
    void
    end() override;
    void
    exchange(Archive &archive) override
    {
      archive(scenery_, *files_);
    }

  private:
    /// Writes a frame (this rank alone). Throws FileError.
    void
    write(const Frame &frame)
    {
      const bool changed = scenery_.include(frame);
      files_->add(frame, scenery_, changed);
    }

    FieldSampler sampler_;
    MPI_Comm communicator_ = MPI_COMM_SELF; ///< of the ranks that share the cells
    Scenery scenery_;
    std::unique_ptr<SnapshotFiles> files_;
  };
} // namespace crawler
