// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/general_sampler.h>
#include <crawler/output/observer.h>

namespace crawler
{
  /// Evaluates the fields at places in this rank's cells, also when the mesh changes.
  class FieldSampler
  {
  public:
    /// Places on a mesh, in cells numbered among this rank's.
    using Places = std::function<std::vector<CellPlace>(const Discretization &)>;

    explicit FieldSampler(Places places);

    /// The fields of a snapshot (collective). Throws NonfiniteStress.
    const Fields &
    sample(const Snapshot &snapshot);

    /// Material coordinates of the places in the latest snapshot [length].
    const std::vector<double> &
    coordinates() const
    {
      return coordinates_;
    }

  private:
    void
    begin_mesh(const Snapshot &snapshot);

    const Places places_;
    // Of the mesh mesh_number_.
    std::optional<unsigned int> mesh_number_;
    std::vector<CellPlace> points_;
    std::vector<double> coordinates_;
    std::vector<double> values_, derivatives_; ///< [point][node] of the shape functions
    std::unique_ptr<ActiveStressAtPoints> stress_;
    std::unique_ptr<GeneralSampler> general_; ///< of a general scene
    std::vector<double> u_local_, v_local_;
    Fields fields_;
  };
} // namespace crawler
