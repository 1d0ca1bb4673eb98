// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_tables.h>
#include <crawler/run/recorder.h>

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

    /// Sample at a time in [step.time - step.size, step.time], valid until the next one.
    Recorder::BodySample
    sample(const LaneStep &step, double time);

  private:
    const LaneSetup &setup_;
    std::vector<unsigned int> cells_; ///< [n_pieces + 1] cells that hold the ends
    std::vector<double> shape_;       ///< [degree + 1][n_pieces + 1] shape functions there
    std::vector<double> integral_;    ///< [unknowns] of each shape function
    std::vector<double> u_, at_ends_;
  };
} // namespace crawler
