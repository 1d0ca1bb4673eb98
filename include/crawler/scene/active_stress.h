// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// Evaluates an active stress at fixed points (the quadrature points of a mesh).
  class ActiveStressAtPoints
  {
  public:
    virtual ~ActiveStressAtPoints() = default;

    /// Writes m(s_i, t) [force] at all points into @p m (as long as the list of points).
    virtual void
    values(double t, std::span<double> m) = 0;
  };

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

  /// Failures in a generator that is the user's own code; its values are NaN there.
  struct StressFailures
  {
    unsigned long count = 0;
    std::string latest; ///< a sentence that names the function, the place and the time
  };

  /**
   * A generator of active stress, m(s,t) [force] at the material point 0 <= s <= L [length] and time t >= 0. To add
   * one, see doc/developer_guide.md. This header is complete, so that a plug-in (stress_plugin.h) needs nothing else.
   */
  class ActiveStress
  {
  public:
    virtual ~ActiveStress() = default;

    /// Makes an evaluator at @p points [length], which may keep whatever does not depend on time.
    virtual std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const = 0;

    /// The smallest P > 0 with m(s, t + P) = m(s, t) for all s and t [time]; nothing if there is none, or none is known
    /// (the default).
    virtual std::optional<double>
    period() const
    {
      return std::nullopt;
    }

    /// The smallest P > 0 and t_0 >= 0 with m(s, t + P) = m(s, t) for all s and t >= t_0.
    struct Repetition
    {
      double period, from; ///< P, t_0 [time]
    };

    /// Repetition of the gait after its start, a ramp for example; nothing if there is none, or none is known. By
    /// default the period from the beginning.
    virtual std::optional<Repetition>
    repetition() const
    {
      const auto P = period();
      return P ? std::optional(Repetition{*P, 0.}) : std::nullopt;
    }

    /// Makes an evaluator of the derivative m_t [force/time] as at() does; null if the generator does not know it.
    virtual std::unique_ptr<ActiveStressAtPoints>
    rate_at([[maybe_unused]] const std::vector<double> &points) const
    {
      return nullptr;
    }

    /// A part of the body in a time interval: s in [s_from, s_to] [length], t in [t_from, t_to] [time].
    struct Box
    {
      double s_from, s_to, t_from, t_to;
    };

    /// Bounds of |m| [force] and |m_t| [force/time].
    struct Bounds
    {
      double value, rate;
    };

    /// Bounds in @p box, without the jumps at breaks_in_time(). They may be too large, but the less so the smaller the
    /// box. A rate is infinite where m may jump. Nothing if the generator does not know (the default): then events
    /// shorter than the sampling of m may be missed.
    virtual std::optional<Bounds>
    bounds([[maybe_unused]] const Box &box) const
    {
      return std::nullopt;
    }

    /// Places in (0, L), in any order, where m or a derivative of it jumps [length], but for echoes: cells end there.
    virtual std::vector<double>
    breaks_in_space() const
    {
      return {};
    }

    /// Times, in any order, when m or a derivative jumps [time], but for echoes by the feedback: steps end at those in
    /// (0, T), T the end time the generator was made for. values() may be on either side at them; so also at 0, T if
    /// they are listed, as they should be if m jumps there (breaks.h).
    virtual std::vector<double>
    breaks_in_time() const
    {
      return {};
    }

    /// Dependence of m on the stretch; null if there is none. With feedback, values() is m of a body at rest.
    virtual const StretchFeedback *
    feedback() const
    {
      return nullptr;
    }

    /// The strain e(s,t) = zeta_s - 1 [1] that this active stress is made to produce, written as an active stress would
    /// be, with its rate; null if it is not made from a strain.
    virtual const ActiveStress *
    prescribed_strain() const
    {
      return nullptr;
    }

    /// Writes lines for the log and for `crawler check`: the choices of this generator. Nothing by default.
    virtual void
    report([[maybe_unused]] std::ostream &out) const
    {
    }

    /// Failures so far; null if the generator never fails (the default).
    virtual const StressFailures *
    failures() const
    {
      return nullptr;
    }
  };
} // namespace crawler
