// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/profile.h>

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// Entries shared by the waves: the change of the active stress within a period.
  struct WaveProfileParameters
  {
    std::string profile = "sine";
    double duty_cycle   = 0.5; ///< [1]
    double front_width  = 0.1; ///< [1], a fraction of the period

    void
    add_parameters(Declarations &declarations);
  };

  /// The profile p(x) of a wave, x counting periods: sin 2 pi x, or +1 for the fraction "duty cycle" of each period and
  /// -1 for the rest, with or without smooth fronts (Switching).
  class WaveProfile
  {
  public:
    /// @p section is the path of the entries, with a slash at the end. Throws InputError if the fronts do not fit into
    /// the period.
    WaveProfile(const WaveProfileParameters &parameters, const std::string &section);

    bool
    is_sine() const
    {
      return !switching_;
    }
    bool
    jumps() const
    {
      return switching_ && switching_->jumps();
    }

    /// Value of p, from -1 to 1.
    double
    value(double x) const;

    /// Derivative p'(x) [1/period], without the jumps.
    double
    rate(double x) const;

    /// Places in (from, to) where p jumps.
    std::vector<double>
    breaks(double from, double to) const
    {
      return switching_ ? switching_->breaks(from, to) : std::vector<double>();
    }

  private:
    std::optional<Switching> switching_; ///< unset: the sine
  };

  /// Declares the entry Direction.
  void
  declare_direction(std::string &direction, Declarations &declarations);

  /// The sign of the velocity: +1 for a wave that runs from the tail (s = 0) to the head (s = L), else -1.
  double
  sign_of(const std::string &direction);

  /// Throws InputError for @p entry if there are more periods until the end time than a run can have, or if each has @p
  /// jumps and they are more than the list of steps should hold.
  void
  require_countable_periods(double frequency, double end_time, bool jumps, const std::string &entry);

  /// Times t in (0, end_time) at which the phase f t + @p start reaches one of the jumps of @p profile.
  std::vector<double>
  times_of_jumps(const WaveProfile &profile, double frequency, double start, double end_time);
} // namespace crawler
