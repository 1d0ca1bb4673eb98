// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class Declarations;

  /// The smooth step S: 0 for x <= 0, 1 for x >= 1, between them S(x) = 1/(1 + exp(1/x - 1/(1-x))). All its derivatives
  /// are continuous, S(x) + S(1-x) = 1, and its largest slope is S'(1/2) = 2.
  double
  smooth_step(double x);

  /// Derivative of the smooth step, S'(x) = S (1-S) (1/x^2 + 1/(1-x)^2).
  double
  smooth_step_rate(double x);

  /// Largest derivative of the smooth step in [from, to].
  double
  largest_smooth_step_rate(double from, double to);

  /// Inverse of the smooth step: the x in (0, 1) with S(x) = @p value, which is between 0 and 1.
  double
  smooth_step_inverse(double value);

  /**
   * Switching on and off once per period. The argument x counts periods: on for the fraction `duty` of each, from x = 0
   * to x = duty, with fronts (smooth steps) of width `front` about both instants, so that the mean over a period is
   * `duty` for any front. With front = 0 the switch jumps.
   */
  class Switching
  {
  public:
    /// @p duty [1] is between 0 and 1; @p front [1] is from 0 to the smaller of duty and 1 - duty (to round-off).
    /// Throws InputError for the entry Front width of @p section, a path with a slash at the end, if it is larger.
    Switching(double duty, double front, const std::string &section = "");

    /// Degree to which it is on, from 0 to 1.
    double
    value(double x) const;

    /// Derivative of value() [1/period]; 0 without fronts, except for the jumps.
    double
    rate(double x) const;

    bool
    jumps() const
    {
      return front_ == 0.;
    }

    /// Places in (from, to), increasing, where it jumps; none with fronts.
    std::vector<double>
    breaks(double from, double to) const;

  private:
    const double duty_, front_;
  };

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
