// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/break_map.h>
#include <crawler/adjoint/cell_points.h>
#include <crawler/equation/general_laws.h>

#include <optional>
#include <vector>

namespace crawler
{
  /**
   * Force N in a body and friction f at points, in natural units of the body. The state is that of another scene at the
   * points; its breaks are mapped to those of this one: with S and R the resulting stretches of the body and of time,
   * w = 1 + e/S, v -> v/R, and a piece of the body is S times as long. The contribution between jumps in time that
   * come together in the other scene is in between().
   */
  class ForcesAtPoints
  {
  public:
    ForcesAtPoints(const Scene &physical, const Scene &other, const std::vector<double> &points);
    ForcesAtPoints(const ForcesAtPoints &) = delete;

    const Units units;

    /// Evaluates at a state within a step that ends at @p end.
    void
    evaluate(double end, const StateAtPoints &at);

    /// Maps a time of the other scene to this one.
    double
    own_time(const double t) const
    {
      return in_time_(in_time_.piece(t), t);
    }

    /// Integral of N at all points over the short times between jumps that come together at the end of a step, or that
    /// enter or leave the run there, less that of the forces of evaluate(); for the state that was evaluated last.
    /// Empty if there are none. (@p start: of the run.)
    std::vector<double>
    between(double time, bool start);

    double
    body_force(const std::size_t point) const
    {
      return body_->N[point];
    }
    /// Friction per length of the other body.
    double
    friction(const std::size_t point) const
    {
      return longer_[point] * friction_->g[point] * friction_->sliding[point];
    }
    double
    longer(const std::size_t point) const
    {
      return longer_[point];
    }
    double
    stress(const std::size_t point) const
    {
      return body_->m[point];
    }

    /// Derivatives of active stress and friction at a point by displacement, stretch, velocity and stretch rate.
    struct Slopes
    {
      double m_w, m_rate, f_u, f_w, f_v;
    };
    /// Slopes at all points, for the state that was evaluated last. Of the scene itself only, not of others.
    std::vector<Slopes>
    slopes() const;

    double
    elastic(const std::size_t point, const double e) const
    {
      return body_->k[point] * e;
    }

  private:
    void
    go_to(std::size_t piece, double t);

    TimeSegments segments_;
    const Scene scene_;
    const BreakMap in_time_;
    std::vector<double> longer_;
    std::optional<BodyForceAtPoints> body_;
    std::optional<FrictionAtPoints> friction_;
    StateAtPoints at_;      ///< the state in this body, at the time of this scene
    std::size_t piece_ = 0; ///< of the active stress there
  };
} // namespace crawler
