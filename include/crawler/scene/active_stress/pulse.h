// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/known_stress.h>

#include <string>

namespace crawler
{
  /// Section "Active stress/Pulse".
  struct PulseParameters
  {
    std::string shape = "gaussian";
    double amplitude  = 0.3;              ///< [force]
    double width      = 0.1;              ///< [length]
    std::optional<double> start_position; ///< [length]; unset: just outside of the body
    std::string direction    = "from tail to head";
    double speed             = 1.; ///< [length/time]
    double repetition_period = 0.; ///< [time]; 0: a single pulse
    EnvelopeParameters envelope;

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * A bump of active stress that runs along the body, once or repeatedly:
   *
   *   m = window(s) ramp(t) A sum_j b( (s - x_j(t))/width ),   x_j(t) = x_0 + sigma v (t - j P),
   *
   * with b(z) = exp(-z^2) (gaussian) or exp(1 - 1/(1-z^2)) for |z| < 1 (compact). The sum is over all integers j:
   * pulses follow each other at the distance v P, and those ahead of the first are on the body at t = 0 if it is longer
   * than that. The period is P; with a ramp, or a single pulse, there is none.
   */
  class Pulse : public KnownStress
  {
  public:
    /// Throws InputError if window or pulses do not fit, or if no pulse reaches the body before the end time.
    Pulse(const PulseParameters &parameters, double length, double end_time);

    std::optional<Bounds>
    bounds(const Box &box) const override;

    /// Reports the initial position of the pulse.
    void
    report(std::ostream &out) const override;

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    void
    require_reachable_body(double end_time) const;

    const bool compact_;
    const double amplitude_, width_;
    const double reach_;             ///< distance from its centre beyond which a pulse is 0 [length]
    const double velocity_, period_; ///< sigma v, P
    const double start_;             ///< x_0
    const double length_;            ///< of the body
    const Window window_;
    const Ramp ramp_;
  };
} // namespace crawler
