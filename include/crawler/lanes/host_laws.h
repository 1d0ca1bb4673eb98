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

    /// Writes the laws that the engine requests; false if one is not a positive number there.
    bool
    evaluate(const LanePoints &at);

    const std::vector<double> k, b; ///< profiles k(s)/k and b(s)

  private:
    const Scene &scene_;
    const std::vector<double> points_;
    std::vector<double> x_;
    std::unique_ptr<FeedbackAtPoints> feedback_;
  };

  /// Laws of @p scene for the engine; null: of a plain one, or in the stretch form.
  LaneBody
  lane_body(const Scene &scene, const HostLaws *laws);
} // namespace crawler
