// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/stretch_form.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/scene/scene.h>

#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace crawler
{
  /// Laws of a general scene in the position form that the host evaluates for the engine, at fixed points.
  class HostLaws : public LawHost
  {
  public:
    /// @p scene is in natural units and must outlive it.
    HostLaws(const Scene &scene, const std::vector<double> &points);

    /// Writes the laws that the engine requests; false if one is not a positive number there.
    bool
    evaluate(const LanePoints &at) override;

    const std::vector<double> k, b; ///< profiles k(s)/k and b(s)

  private:
    const Scene &scene_;
    const std::vector<double> points_;
    std::vector<double> x_;
    std::unique_ptr<FeedbackAtPoints> feedback_;
  };

  /// Laws of a general scene in the stretch form that the host evaluates for the engine.
  class HostCellLaws : public LawHost
  {
  public:
    /// @p scene is in natural units and must outlive it.
    HostCellLaws(const Scene &scene, const std::vector<double> &middles);

    double
    evaluate_cells(double t, const double *m, const double *w, const double *rate, CellLaws<double> &at_cells) override;

    /// Stretch and friction where a friction law was not positive; nothing if all were.
    std::optional<std::pair<double, double>> bad_friction;

  private:
    const Scene &scene_;
    StretchLaws laws_;
  };

  /// Laws of @p scene for the engine; null: of a plain one, or in the stretch form.
  LaneBody
  lane_body(const Scene &scene, HostLaws *laws);
} // namespace crawler
