// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/shared_choice.h>
#include <crawler/studies/core/compute.h>
#include <crawler/studies/sweep/sweep_points.h>

#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace crawler
{
  /// Consecutive points.
  struct SweepBlock
  {
    unsigned long first, size;
  };

  /**
   * Numerics that the points of a block share, measured on a few of them that lie as far apart as possible. Where these
   * have nothing in common the halves of the block are tried, and so on. The answer for a point depends on its block
   * alone, not on who asks and in which order. Sweeps of few points share nothing: each rank would measure for too few
   * points. With a cross-check each point chooses for itself, as `crawler run` does.
   */
  class SweepNumerics
  {
  public:
    explicit SweepNumerics(SweepPoints &points)
      : points_(points)
    {
    }

    /// Returns true if the points of this sweep share numerics.
    static bool
    are_shared(const SweepPoints &points)
    {
      return points.design().n_points() >= 512 && !points.sweep().cross_check;
    }

    struct Shared
    {
      SweepBlock points;          ///< points that share it
      const SharedChoice *choice; ///< null if they share nothing; valid until a point of another block is requested
    };

    /// Numerics of the points from @p point on; @p keep_going may end the search, which is not begun again then.
    Shared
    at(const SweepBlock &block, unsigned long point, const std::function<bool()> &keep_going);

    /// Estimate of the displacement of a point from those of the examples [length].
    double
    size_at(const Shared &shared, unsigned long point);

    /// Task of a point.
    Task
    task(const unsigned long point) const
    {
      Task one;
      one.parameters = points_.parameters(point);
      one.gait       = true;
      return one;
    }

  private:
    struct Known
    {
      std::optional<SharedChoice> choice;
      std::vector<std::vector<double>> places; ///< [example][axis]
      std::vector<double> spread;              ///< [axis] of all points
    };

    Known
    measure(const SweepBlock &part, const std::function<bool()> &keep_going) const;
    std::vector<double>
    place(unsigned long point) const;

    SweepPoints &points_;
    std::optional<unsigned long> block_;                             ///< first point of the block
    std::map<std::pair<unsigned long, unsigned long>, Known> known_; ///< knowledge about that block and its parts
  };
} // namespace crawler
