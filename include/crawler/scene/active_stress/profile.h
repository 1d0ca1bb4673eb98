// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
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
} // namespace crawler
