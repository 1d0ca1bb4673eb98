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
  /**
   * Fixed places of the body on a mesh, where a field is evaluated that has one coefficient at each stretch point of
   * each cell of the whole mesh [cell][q]: the strain.
   */
  class StretchPlaces
  {
  public:
    /// @p points [length] beyond the body stand for its end.
    StretchPlaces(const std::vector<Cell> &cells, const ReferenceElement &element, const std::vector<double> &points);

    void
    interpolate(std::span<const double> coefficients, std::span<double> values) const;

  private:
    unsigned int q_;
    std::vector<CellPlace> places_;
    std::vector<double> weights_; ///< [point][q]
  };

  /// Past stretch of the whole body, from the dense output of the accepted steps; the same on all ranks. Meshes and
  /// formulations may change from step to step.
  class StretchHistory
  {
  public:
    /// Places in a step, from 0 to 1, where its stretch is kept: polynomials in between are exact up to degree 5.
    static const std::array<double, 6> &
    places();

    struct Step
    {
      double from = 0., to = 0.; ///< [time]
      std::shared_ptr<const std::vector<Cell>> cells;
      const ReferenceElement *element = nullptr;
      std::array<std::vector<double>, 6> coefficients; ///< coefficients at the places(), for StretchPlaces
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

    /// Coefficients at the time @p t of a step.
    static void
    coefficients(const Step &step, double t, std::vector<double> &values);

  private:
    std::deque<Step> steps_;
  };
} // namespace crawler
