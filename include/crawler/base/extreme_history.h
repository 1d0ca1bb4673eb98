// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/parabola.h>

#include <array>
#include <cmath>

namespace crawler
{
  /// An extreme value with its place and time.
  struct Extreme
  {
    double value = 1., s = 0., t = 0.;
    double jump = 0.; ///< jump of a continuous quantity at the end of the cell of s: possible error of the value
  };

  /// Keeps the smallest (or largest) of the values shown to it in order of time, sharpened between samples by the
  /// parabola through three of them.
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

    /// Adds a value that does not continue the previous ones smoothly.
    void
    add_alone(const Extreme &now)
    {
      last_.fill(now);
      if (is_beyond(now.value, extreme_.value))
        extreme_ = now;
    }

    /// Separates later values from earlier ones: they do not continue them smoothly.
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
    /// The value before the last one.
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
