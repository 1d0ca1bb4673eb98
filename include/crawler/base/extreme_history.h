// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/parabola.h>

#include <array>
#include <cmath>

namespace crawler
{
  /// An extreme value, and where and when it was seen.
  struct Extreme
  {
    double value = 1., s = 0., t = 0.;
    double jump = 0.; ///< of what should be continuous, where the cell of s ends: what the value may be wrong by
  };

  /// Keeps the smallest (or the largest) of the values that are shown to it in the order of time. Between them the
  /// parabola through three of them comes closer.
  class ExtremeHistory
  {
  public:
    enum Kind
    {
      smallest,
      largest
    };

    explicit ExtremeHistory(const Kind kind)
      : sign_(kind == smallest ? 1. : -1.)
    {
    }

    void
    start(const Extreme &now)
    {
      last_.fill(now);
      extreme_ = now;
    }

    void
    add(const Extreme &now)
    {
      last_ = {{last_[1], last_[2], now}};
      if (is_beyond(now.value, extreme_.value))
        extreme_ = now;
      const auto &[before, middle, after] = last_;
      if (before.t < middle.t && is_beyond(middle.value, before.value) && is_beyond(middle.value, after.value))
      {
        const auto [t, value] = parabola_vertex(before.t, before.value, middle.t, middle.value, after.t, after.value);
        if (is_beyond(value, extreme_.value) && value > 0.)
          extreme_ = {value, middle.s, t, middle.jump + std::abs(value - middle.value)};
      }
    }

    /// A value that does not go on smoothly from those before.
    void
    add_alone(const Extreme &now)
    {
      last_.fill(now);
      if (is_beyond(now.value, extreme_.value))
        extreme_ = now;
    }

    /// What comes does not go on smoothly from what was.
    void
    interrupt()
    {
      last_.fill(last_[2]);
    }

    const Extreme &
    extreme() const
    {
      return extreme_;
    }
    /// The value shown before the last one.
    const Extreme &
    before_last() const
    {
      return last_[1];
    }

    bool
    is_beyond(const double a, const double b) const
    {
      return sign_ * a < sign_ * b;
    }

    void
    exchange(auto &archive)
    {
      archive(last_, extreme_);
    }

  private:
    double sign_;
    std::array<Extreme, 3> last_;
    Extreme extreme_;
  };
} // namespace crawler
