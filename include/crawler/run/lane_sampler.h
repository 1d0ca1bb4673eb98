// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_tables.h>

#include <span>
#include <vector>

namespace crawler
{
  /// Displacement of a body in a lane of the fused engine at the ends of equal pieces, at any time within a step (the
  /// collocation polynomial of the stages); natural units.
  class LaneSampler
  {
  public:
    /// @p setup is kept as a reference.
    LaneSampler(const LaneSetup &setup, unsigned int n_pieces);

    /// Looks at a time in [step.time - step.size, step.time].
    void
    sample(const LaneStep &step, double time);

    /// Displacements [n_pieces + 1] of the last sample.
    std::span<const double>
    displacement() const
    {
      return at_ends_;
    }
    double
    mean_displacement() const
    {
      return mean_;
    }

  private:
    const LaneSetup &setup_;
    std::vector<unsigned int> cells_; ///< [n_pieces + 1] cells that hold the ends
    std::vector<double> shape_;       ///< [degree + 1][n_pieces + 1] shape functions there
    std::vector<double> integral_;    ///< [unknowns] of each shape function
    std::vector<double> u_, at_ends_;
    double mean_ = 0.;
  };
} // namespace crawler
