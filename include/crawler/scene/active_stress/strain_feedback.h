// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/known_stress.h>

#include <optional>
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

  /// Fact of a feedback that is not admitted, by the name of its entry.
  struct BadFact
  {
    std::string name;
    double value;
    std::string expected;
  };

  /// First fact that is not admitted for a body of this @p length [length] and this @p end_time [time].
  std::optional<BadFact>
  bad_fact(const StretchFeedback::Facts &facts, double length, double end_time);

  /**
   * An active stress that responds to the stretch (proprioception): a formula m(s, t, w, w_t, w_near, w_delayed) of the
   * stretch w, its rate w_t, the stretch at the place s + distance (at the end of the body if that is beyond it), or
   * its mean over a sensor around that place, and the stretch at the time t - delay (the initial stretch before t = 0).
   * Derivatives are exact.
   */
  class StrainFeedback : public KnownStress
  {
  public:
    /// Throws InputError if the formula, the constants, the distance, the delay or the sensor do not make sense.
    StrainFeedback(const StrainFeedbackParameters &parameters, double length, double end_time);

  private:
    /// Makes an evaluator for a body with the stretch 1 at rest.
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;
  };
} // namespace crawler
