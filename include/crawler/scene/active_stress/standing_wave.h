// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/active_stress/wave_entries.h>
#include <crawler/scene/known_stress.h>

namespace crawler
{
  class Declarations;

  /// Section "Active stress/Standing wave".
  struct StandingWaveParameters
  {
    double amplitude = 0.1, offset = 0.; ///< [force]
    double wave_number    = 1.;          ///< waves on the body [1]
    double phase_in_space = 0.;          ///< [rad]
    double frequency      = 1.;          ///< [1/time]
    double phase          = 0.;          ///< [rad]
    WaveProfileParameters profile;
    EnvelopeParameters envelope;

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * A wave whose nodes stay where they are:
   *
   *   m = window(s) ramp(t) [ offset + A cos( 2 pi n s/L + phase in space ) p( f t + phase/(2 pi) ) ],
   *
   * with the profile p (wave_entries.h). Its period is 1/f; with a ramp it has none. A square wave, which jumps, has no
   * rate.
   */
  class StandingWave : public KnownStress
  {
  public:
    static constexpr const char *description = "a wave whose nodes stay in their places";

    /// Throws InputError if fronts or window do not fit, or if there are more than 1e8 periods (1e6 of a square wave).
    StandingWave(const StandingWaveParameters &parameters, double length, double end_time);

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    const double amplitude_, offset_;
    const double wave_number_, start_in_space_; ///< [rad/length], [rad]
    const double frequency_, start_;            ///< [1/time], [periods]
    const WaveProfile profile_;
    const Envelope envelope_;
  };
} // namespace crawler
