// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /// Input of an active stress with feedback at the points: all spans are as long as the list of points, or empty where
  /// unused.
  struct StretchSeen
  {
    std::span<const double> stretch; ///< w(s_i, t) [1]
    std::span<const double> rate;    ///< w_t(s_i, t) [1/time]
    /// w(s_i + distance, t) [1], at the end of the body if that is beyond it; with a sensor, the mean over the sensor
    std::span<const double> near;
    std::span<const double> delayed; ///< w(s_i, t - delay) [1]; the initial stretch before t = 0
  };

  /// Output of the feedback: the active stress and its derivatives with respect to the present input.
  struct FeedbackStress
  {
    std::span<double> m;      ///< [force]
    std::span<double> m_w;    ///< dm/dw [force]; empty like the others below if only m is wanted
    std::span<double> m_rate; ///< dm/dw_t [force time]
    std::span<double> m_near; ///< dm/d(w near) [force]
  };

  /// Evaluates an active stress with feedback at fixed points.
  class FeedbackAtPoints
  {
  public:
    virtual ~FeedbackAtPoints() = default;

    /// Writes all of @p m, including the part that does not depend on the stretch.
    virtual void
    values(double t, const StretchSeen &seen, const FeedbackStress &m) = 0;
  };

  /// An active stress m(s, t, w, w_t, w near, w delayed). Derivatives are exact.
  struct StretchFeedback
  {
    struct Facts
    {
      bool uses_rate = false;
      double distance =
        0.;              ///< of the near stretch [length], either sign; 0 if it is not used, or a sensor is at s itself
      double delay = 0.; ///< [time], positive; 0 if no delayed stretch is used
      /// Sensor length b [length]; if positive, the near stretch is the mean over the piece of this length centred at s
      /// + distance, moved inside where it would reach beyond the body: (zeta(right) - zeta(left))/b. 0: at the place.
      double sensor_length = 0.;

      /// True if the near stretch is used.
      bool
      sees_near() const
      {
        return distance != 0. || sensor_length != 0.;
      }
    };

    Facts facts;
    /// Makes an evaluator at points [length].
    std::function<std::unique_ptr<FeedbackAtPoints>(const std::vector<double> &points)> at;
  };
} // namespace crawler
