// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <utility>

namespace crawler
{
  /// Vertex (x, y) of the parabola through three points with x0 < x1 < x2 whose middle one is an extreme of the
  /// three. Sharpens an extreme that was found by sampling from second to third order in the distance of the samples.
  inline std::pair<double, double>
  parabola_vertex(const double x0, const double y0, const double x1, const double y1, const double x2, const double y2)
  {
    const double left = (y1 - y0) / (x1 - x0), right = (y2 - y1) / (x2 - x1);
    const double curvature = (right - left) / (x2 - x0);
    if (curvature == 0.)
      return {x1, y1};
    const double slope = left + curvature * (x1 - x0); // at x1
    const double x     = x1 - 0.5 * slope / curvature;
    return {x, y1 - 0.25 * slope * slope / curvature};
  }
} // namespace crawler
