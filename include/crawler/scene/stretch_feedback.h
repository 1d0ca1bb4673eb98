// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /// What an active stress with feedback sees at the points: all spans are as long as the list of points, or empty
  /// where the feedback does not use them.
  struct StretchSeen
  {
    std::span<const double> stretch; ///< w(s_i, t) [1]
    std::span<const double> rate;    ///< w_t(s_i, t) [1/time]
    /// w(s_i + distance, t) [1], at the end of the body if that is beyond it; with a sensor its mean over the sensor
    std::span<const double> near;
    std::span<const double> delayed; ///< w(s_i, t - delay) [1]; that of the start before t = 0
  };

  /// What it answers: the active stress and its derivatives with respect to what it sees at the same time.
  struct FeedbackStress
  {
    std::span<double> m;      ///< [force]
    std::span<double> m_w;    ///< dm/dw [force]; empty like the others below if only m is wanted
    std::span<double> m_rate; ///< dm/dw_t [force time]
    std::span<double> m_near; ///< dm/d(w near) [force]
  };

  /// Evaluates an active stress with feedback at points that do not change.
  class FeedbackAtPoints
  {
  public:
    virtual ~FeedbackAtPoints() = default;

    /// Writes all of @p m, including what does not depend on the stretch.
    virtual void
    values(double t, const StretchSeen &seen, const FeedbackStress &m) = 0;
  };

  /// An active stress m(s, t, w, w_t, w near, w delayed). Derivatives are exact.
  class StretchFeedback
  {
  public:
    virtual ~StretchFeedback() = default;

    virtual std::unique_ptr<FeedbackAtPoints>
    at(const std::vector<double> &points) const = 0;

    virtual bool
    uses_rate() const = 0;

    /// [length], either sign; 0 if the stretch of no other place is used, or a sensor is at the place itself.
    virtual double
    distance() const = 0;

    /// [time], positive; 0 if no delayed stretch is used.
    virtual double
    delay() const = 0;

    /// [length], b; if positive, the near stretch is the mean stretch of the piece of this length with its middle at
    /// s + distance, moved inside where it would reach beyond the body: (zeta(right) - zeta(left))/b. 0: at the place.
    virtual double
    sensor_length() const
    {
      return 0.;
    }

    /// Is the near stretch used?
    bool
    sees_near() const
    {
      return distance() != 0. || sensor_length() != 0.;
    }
  };
} // namespace crawler
