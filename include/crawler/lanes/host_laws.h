// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/scene/scene.h>

#include <memory>
#include <vector>

namespace crawler
{
  /// Laws of a general scene in the position form that the host evaluates for the engine, at fixed points.
  class HostLaws
  {
  public:
    /// @p scene is in natural units and must outlive it.
    HostLaws(const Scene &scene, const std::vector<double> &points);

    /// Sets the part of @p job that describes the scene.
    void
    set(LaneJob &job) const;

    /// Writes the laws that the engine requests; false if one is not a positive number there.
    bool
    evaluate(const LanePoints &at);

  private:
    const Scene &scene_;
    const std::vector<double> points_;
    std::vector<double> k_, b_; ///< profiles k(s)/k and b(s)
    std::vector<double> x_;
    std::unique_ptr<FeedbackAtPoints> feedback_;
  };
} // namespace crawler
