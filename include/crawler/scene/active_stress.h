// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/strain_history.h>
#include <crawler/scene/stretch_feedback.h>

#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// Evaluates an active stress at points that do not change (the quadrature points of a mesh).
  class ActiveStressAtPoints
  {
  public:
    virtual ~ActiveStressAtPoints() = default;

    /// Writes m(s_i, t) [force] at all points into @p m (as long as the list of points).
    virtual void
    values(double t, std::span<double> m) = 0;
  };

  /// What went wrong in a generator that is code of the user's; its values are not a number there.
  struct StressFailures
  {
    unsigned long count = 0;
    std::string latest; ///< a sentence that names the function, the place and the time
  };

  /**
   * A generator of active stress. It answers one question: what is the active stress m(s,t) [force] at
   * the material point 0 <= s <= L [length] and time t >= 0? To add one, see doc/developer_guide.md.
   * All of it is in this header, so that a plug-in (stress_plugin.h) needs nothing else.
   */
  class ActiveStress
  {
  public:
    virtual ~ActiveStress() = default;

    /// An evaluator at @p points [length] that may keep whatever does not depend on time.
    virtual std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const = 0;

    /// The smallest P > 0 with m(s, t + P) = m(s, t) for all s and t [time]; nothing if there is none, or if it is not
    /// known (the default).
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

    /// That of the gait, once its start is over, a ramp for example; nothing if there is none, or if it is not known.
    /// By default the period from the beginning.
    virtual std::optional<Repetition>
    repetition() const
    {
      const auto P = period();
      return P ? std::optional(Repetition{*P, 0.}) : std::nullopt;
    }

    /// The same as at() for the derivative m_t [force/time]; null if the generator does not know it.
    virtual std::unique_ptr<ActiveStressAtPoints>
    rate_at([[maybe_unused]] const std::vector<double> &points) const
    {
      return nullptr;
    }

    using Box    = SpaceTimeBox;
    using Bounds = FieldBounds; ///< of m [force] and m_t [force/time]

    /// Those in @p box, without the jumps at breaks_in_time(). They may be too large, but the less so the smaller the
    /// box. A rate is infinite where m may jump. Nothing if the generator cannot tell (the default): then events that
    /// are shorter than the times at which m is sampled may be missed.
    virtual std::optional<Bounds>
    bounds([[maybe_unused]] const Box &box) const
    {
      return std::nullopt;
    }

    /// Places in (0, L), in any order, where m or a derivative of it jumps [length]: cells of the mesh end there.
    virtual std::vector<double>
    breaks_in_space() const
    {
      return {};
    }

    /// Times, in any order, when m or a derivative of it jumps [time]: steps end at those in (0, T). T is the end time
    /// that the generator was made for. On which side values() is at such a time does not matter, nor at 0 and at T if
    /// they are listed too, as they should be if m jumps there (breaks.h).
    virtual std::vector<double>
    breaks_in_time() const
    {
      return {};
    }

    /// How m depends on the stretch besides place and time; null if it does not. Then values() is m of a body at rest.
    virtual const StretchFeedback *
    feedback() const
    {
      return nullptr;
    }

    /// The strain that this active stress is made to bring about; null if it is not made from a strain.
    virtual const StrainHistory *
    prescribed_strain() const
    {
      return nullptr;
    }

    /// Writes lines for the log and for `crawler check`: what this generator chose. Nothing by default.
    virtual void
    report([[maybe_unused]] std::ostream &out) const
    {
    }

    /// What has gone wrong up to now; null if the generator never fails (the default).
    virtual const StressFailures *
    failures() const
    {
      return nullptr;
    }
  };
} // namespace crawler
