// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula.h>
#include <crawler/scene/active_stress.h>

#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Strain feedback".
  struct StrainFeedbackParameters
  {
    std::string active_stress = "-0.2*(w-1)";
    std::string constants     = "";
    double distance           = 0.; ///< [length]
    double delay              = 0.; ///< [time]
    double sensor_length      = 0.; ///< [length]

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * An active stress that answers to the stretch (proprioception): a formula m(s, t, w, w_t, w_near, w_delayed) of the
   * stretch w, its rate w_t, the stretch at the place s + distance (at the end of the body if that is beyond it), or
   * its mean over a sensor around that place, and the stretch of the time t - delay (the initial stretch before
   * t = 0). Derivatives are exact.
   */
  class StrainFeedback : public ActiveStress
  {
  public:
    static constexpr const char *description =
      "a formula of s, t, the stretch, its rate, and stretches nearby and before";

    /// Throws InputError if the formula, the constants, the distance, the delay or the sensor do not make sense.
    StrainFeedback(const StrainFeedbackParameters &parameters, double length, double end_time);

    /// Of a body with the stretch 1 at rest.
    std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const override;

    ~StrainFeedback() override;

    /// Where the place of w_near, or the sensor, reaches the end of the body, and where that is seen from in turn.
    std::vector<double>
    breaks_in_space() const override;

    /// The past begins at t = 0: what follows from it has kinks at the first multiples of the delay.
    std::vector<double>
    breaks_in_time() const override;

    const StretchFeedback *
    feedback() const override;

  private:
    class Feedback;

    const double length_, end_time_;
    std::shared_ptr<const Feedback> feedback_;
  };
} // namespace crawler
