// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/mesh/discretization.h>

#include <array>
#include <deque>
#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /// Past displacement of the whole body, from the dense output of the accepted steps; the same on all ranks. Meshes
  /// may change from step to step.
  class StretchHistory
  {
  public:
    /// Places in a step, from 0 to 1, where its displacement is kept: polynomials in between are exact up to degree 5.
    static const std::array<double, 6> &
    places();

    struct Step
    {
      double from = 0., to = 0.; ///< [time]
      std::shared_ptr<const std::vector<Cell>> cells;
      const ReferenceElement *element = nullptr;
      std::array<std::vector<double>, 6> u; ///< displacement at the places() [node of the whole mesh]
    };

    void
    clear();

    void
    exchange(Archive &archive);

    /// Adds a step that follows the last one; drops those that end before @p forget.
    void
    add(Step step, double forget);

    /// Step to which the time @p t belongs, or the nearest; null if there is none, or for times before the first.
    const Step *
    find(double t) const;

    /// Displacement @p u at the time @p t of a step.
    static void
    displacement(const Step &step, double t, std::vector<double> &u);

  private:
    std::deque<Step> steps_;
  };
} // namespace crawler
