// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_adjoint.h>

#include <cstddef>
#include <vector>

namespace crawler
{
  /// State at all points at a time: displacement, velocity, strain, stretch and its rate.
  struct StateAtPoints
  {
    double t = 0.;
    std::vector<double> u, v, e, w, rate;

    explicit StateAtPoints(std::size_t n);
  };

  /// States in the stages of a recorded run, step by step from the last one to the first.
  class BackwardStages
  {
  public:
    BackwardStages(const LaneRecord &steps, const LaneSetup &setup);

    /// Goes to the step before the present one, which is the last one at first.
    void
    go_back(std::size_t step);

    /// Goes to a stage of that step.
    void
    go_to_stage(unsigned int stage);

    double time = 1.;         ///< time of the stage
    std::vector<double> u, v; ///< displacement and velocity in the stage

  private:
    const LaneRecord &steps_;
    const LaneSetup &setup_;
    std::size_t step_ = 0;
    std::vector<double> y_; ///< state at the start of the step
  };

  /// Gauss points of all cells, for a body of length 1.
  class CellPoints
  {
  public:
    /// @p n_more points in each cell beyond the degree + 1 of the run itself. @p setup must outlive it.
    explicit CellPoints(const LaneSetup &setup, unsigned int n_more = 0);

    const std::size_t per_cell;
    const std::vector<double> places; ///< [per_cell] in a cell of size 1
    std::vector<double> points;

    std::size_t
    size() const
    {
      return points.size();
    }
    std::size_t
    cell_of(const std::size_t point) const
    {
      return point / per_cell;
    }
    /// Weight of the quadrature.
    double
    weight(std::size_t point) const;

    /// Evaluates a field, and its derivative by s, from its values at the nodes.
    void
    evaluate(const double *nodal, std::vector<double> &values, std::vector<double> &slopes) const;
    /// Adds to the nodes: for each the sum of @p values times its shape function and of @p slopes times the derivative
    /// of that.
    void
    add_to_nodes(const std::vector<double> &values, const std::vector<double> &slopes, double *nodal) const;
    /// Evaluates the state in a stage.
    void
    evaluate(const BackwardStages &stages, StateAtPoints &at) const;

  private:
    const LaneSetup &setup_;
    const std::vector<double> weights_, values_, slopes_; ///< tables of a cell of size 1: [point], [point][node]
  };
} // namespace crawler
