// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/assembler.h>

namespace crawler
{
  /// The fields that are written, at a list of points.
  struct Fields
  {
    std::vector<double> position, displacement, stretch, velocity, active_stress, elastic_stress, friction_force;
  };

  /// Evaluates the fields at points inside this rank's cells.
  class FieldSampler
  {
  public:
    struct Point
    {
      unsigned int cell; ///< number among this rank's cells
      double x;          ///< from 0 to 1 in the cell
    };

    FieldSampler(const Scene &scene, const Discretization &discretization, std::vector<Point> points);

    /// The fields for owned vectors @p u, @p v (collective).
    const Fields &
    sample(double t, std::span<const double> u, std::span<const double> v);

    /// Material coordinates of the points [length].
    const std::vector<double> &
    coordinates() const
    {
      return coordinates_;
    }

  private:
    const Scene &scene_;
    const Discretization &discretization_;
    const std::vector<Point> points_;
    std::vector<double> coordinates_;
    std::vector<double> values_, derivatives_; ///< [point][node] shape functions
    std::unique_ptr<ActiveStressAtPoints> stress_;
    std::vector<double> u_local_, v_local_;
    Fields fields_;
  };
} // namespace crawler
