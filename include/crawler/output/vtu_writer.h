// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/field_sampler.h>
#include <crawler/output/observer.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace crawler
{
  /**
   * Writes each snapshot as solution/NUMBER.vtu and keeps solution.pvd up to date, so that what is written is a
   * complete animation at any moment. A cell of degree q is written as q lines; the stretch is not averaged between
   * cells. In ParaView "Warp By Vector" of the displacement shows the moving body.
   */
  class VtuWriter : public Observer
  {
  public:
    explicit VtuWriter(const std::filesystem::path &folder);

    void
    observe(const Snapshot &snapshot) override;

    /// A cell from one place to another [length].
    struct Cell
    {
      double left, right;
    };

    /// Writes one snapshot: @p fields at @p n_points equidistant points of each of this rank's cells (collective).
    void
    write(double time,
          unsigned int number,
          const std::vector<Cell> &cells,
          unsigned int n_points,
          const Fields &fields,
          MPI_Comm communicator);

  private:
    /// Adds a line to solution.pvd.
    void
    add_to_record(double time, const std::string &name);

    const std::filesystem::path folder_;
    std::unique_ptr<FieldSampler> sampler_; ///< for the mesh of this number
    unsigned int mesh_number_ = 0;
    unsigned int n_files_     = 0;
    std::ofstream record_;          ///< solution.pvd, on rank 0
    std::streamoff record_end_ = 0; ///< where its last lines begin
  };
} // namespace crawler
