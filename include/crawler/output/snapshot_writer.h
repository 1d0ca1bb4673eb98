// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/field_sampler.h>
#include <crawler/output/output_parameters.h>
#include <crawler/output/scenery.h>

#include <filesystem>
#include <memory>
#include <string>

namespace crawler
{
  /// The file of a format to be opened in ParaView.
  std::string
  animation_file(SnapshotFormat format);

  /**
   * Writes the snapshots of a run, or given frames, to files of one format: a complete animation after each snapshot.
   * The fields are sampled at q + 1 equidistant points of each cell of degree q; the stretch is not averaged between
   * cells. Rank 0 writes.
   */
  class SnapshotWriter : public Observer
  {
  public:
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
      archive(scenery_);
    }

  protected:
    /// Takes the length L [length].
    explicit SnapshotWriter(double length);

    /// Adds a frame, which the scenery includes; @p scenery_changed is the result of Scenery::include(). Throws
    /// FileError.
    virtual void
    add(const Frame &frame, bool scenery_changed) = 0;

    /// Ends the files after the last frame, with the final scenery. Throws FileError.
    virtual void
    end_files() = 0;

    const double length_;
    Scenery scenery_;

  private:
    /// Writes a frame (this rank alone). Throws FileError.
    void
    write(const Frame &frame)
    {
      const bool changed = scenery_.include(frame);
      add(frame, changed);
    }

    FieldSampler sampler_;
    MPI_Comm communicator_ = MPI_COMM_SELF; ///< of the ranks that share the cells
  };

  /// Writes solution.pvd (body, ground, grip and scale of each frame) and line.pvd (the body as a line with s on the x
  /// axis). Both name files in solution/.
  std::shared_ptr<SnapshotWriter>
  vtu_files(const std::filesystem::path &folder, double length);

  /// Writes solution.h5, described by solution.xdmf and line.xdmf as above, for @p n_frames expected frames.
  std::shared_ptr<SnapshotWriter>
  xdmf_files(const std::filesystem::path &folder, double length, std::size_t n_frames);
} // namespace crawler
