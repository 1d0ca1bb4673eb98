// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/strain_history.h>

#include <iosfwd>
#include <memory>
#include <optional>
#include <span>
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

  /**
   * A generator of active stress. It answers one question: what is the active stress m(s,t) [force] at
   * the material point 0 <= s <= L [length] and time t >= 0? To add one, see doc/developer_guide.md.
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
    period() const;

    /// The same for the derivative m_t [force/time]; null if the generator does not know it.
    virtual std::unique_ptr<ActiveStressAtPoints>
    rate_at(const std::vector<double> &points) const;

    /// The strain that this active stress is made to bring about; null if it is not made from a strain.
    virtual const StrainHistory *
    prescribed_strain() const;

    /// Writes lines for the log and for `crawler check`: what this generator chose. Nothing by default.
    virtual void
    report(std::ostream &out) const;
  };
} // namespace crawler
