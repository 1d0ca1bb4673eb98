// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/output/field_sampler.h>
#include <crawler/output/observer.h>

#include <filesystem>
#include <vector>

namespace crawler
{
  /// Collects the snapshots at equidistant points of the body and writes them as one structured grid over s and t
  /// (kymograph.vts: x is s/L, y is t/T) when the run ends.
  class KymographWriter : public Observer
  {
  public:
    static constexpr unsigned int n_points = 201; ///< equidistant, both ends included

    KymographWriter(double length, double end_time, const std::filesystem::path &folder);

    void
    observe(const Snapshot &snapshot) override;
    void
    end() override;

    /// Adds a time with @p fields at all points.
    void
    add(double time, const Fields &fields);

  private:
    const double length_, end_time_;
    const std::filesystem::path folder_;
    std::unique_ptr<FieldSampler> sampler_; ///< for the mesh of this number
    unsigned int mesh_number_ = 0;
    std::vector<double> times_;
    Fields rows_; ///< [time][point], on rank 0
  };
} // namespace crawler
