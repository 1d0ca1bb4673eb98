// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/scene.h>

#include <cstddef>
#include <vector>

namespace crawler
{
  /// Breaks in space of a scene, in units of its length.
  std::vector<double>
  breaks_in_space_of(const Scene &scene);

  /// Breaks in time of a scene, in units of its duration.
  std::vector<double>
  breaks_in_time_of(const Scene &scene);

  /**
   * Map from [0, 1] to [0, 1], linear between breaks, from the breaks of one scene to the nearby ones of another: where
   * several come together in the one, to their mean in the other.
   */
  struct BreakMap
  {
    BreakMap(const std::vector<double> &one, const std::vector<double> &other);

    /// True if both have the same number of breaks.
    bool
    is_one_to_one() const;

    /// Number of the piece that contains @p x; the left one at a break.
    std::size_t
    piece(double x) const;
    double
    slope(std::size_t piece) const;
    double
    operator()(std::size_t piece, double x) const;
    /// Number of the piece of the other scene that this one becomes.
    std::size_t
    image(std::size_t piece) const;

    std::vector<double> from, to;             ///< breaks of the one scene and both ends, and what they become
    std::vector<std::vector<double>> bunches; ///< breaks of the other scene near each of these
    /// True if each break of the one scene has some of the other near it, and the other has no more except at the ends.
    bool is_good = true;
  };
} // namespace crawler
