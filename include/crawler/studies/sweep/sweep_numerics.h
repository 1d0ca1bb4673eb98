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
  /// Points in succession.
  struct SweepBlock
  {
    unsigned long first, size;
  };

  /**
   * The numerics that the points of a block share, measured on a few of them that lie as far apart as they can. Where
   * these have nothing in common the halves of the block are tried, and so on. The answer for a point depends on its
   * block alone, not on who asks and in which order. Sweeps of few points share nothing: there each rank would measure
   * for too few points. With a cross-check each point chooses for itself, as `crawler run` does.
   */
  class SweepNumerics
  {
  public:
    explicit SweepNumerics(SweepPoints &points);

    /// Do the points of this sweep share anything?
    static bool
    are_shared(const SweepPoints &points)
    {
      return points.design().n_points() >= 512 && !points.sweep().cross_check;
    }

    struct Shared
    {
      SweepBlock points;          ///< that share it
      const SharedChoice *choice; ///< null if they share nothing; good until a point of another block is asked for
    };

    /// For the points from @p point on; @p keep_going may end the search, which is not begun again then.
    Shared
    at(const SweepBlock &block, unsigned long point, const std::function<bool()> &keep_going);

    /// About what the displacement of a point is, from those of the examples [length].
    double
    size_at(const Shared &shared, unsigned long point);

    /// A point as a task.
    Task
    task(unsigned long point) const;

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
    std::optional<unsigned long> block_;                             ///< its first point
    std::map<std::pair<unsigned long, unsigned long>, Known> known_; ///< of that block and its parts
  };
} // namespace crawler
