// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/adjoint/forces_at_points.h>

namespace crawler
{
  std::vector<double>
  breaks_in_space_of(const Scene &scene)
  {
    std::vector<double> list = scene.breaks_in_space();
    for (double &place : list)
      place /= scene.body.length;
    return list;
  }

  std::vector<double>
  breaks_in_time_of(const Scene &scene)
  {
    return TimeSegments(*scene.active_stress, scene.end_time).breaks();
  }

  void
  evaluate_at_points(const LaneSetup &setup,
                     const double *nodal,
                     std::vector<double> &values,
                     std::vector<double> &slopes)
  {
    const std::size_t n = setup.degree + 1;
    for (std::size_t c = 0; c < setup.n_cells; ++c)
      for (std::size_t p = 0; p < n; ++p)
      {
        double value = 0., slope = 0.;
        for (std::size_t i = 0; i < n; ++i)
        {
          value += setup.values[p * n + i] * nodal[c * setup.degree + i];
          slope += setup.derivatives[p * n + i] * nodal[c * setup.degree + i];
        }
        values[c * n + p] = value;
        slopes[c * n + p] = slope / setup.sizes[c];
      }
  }
} // namespace crawler
