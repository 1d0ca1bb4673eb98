// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/active_stress/wave_entries.h>
#include <crawler/scene/known_stress.h>

#include <string>

namespace crawler
{
  /// Section "Active stress/Travelling wave".
  struct TravellingWaveParameters
  {
    double amplitude = 0.1, offset = 0.; ///< [force]
    double wave_number    = 1.;          ///< waves on the body [1]
    std::string direction = "from head to tail";
    std::string given_by  = "frequency";
    double frequency      = 1.; ///< [1/time]
    double wave_speed     = 1.; ///< [length/time]
    double phase          = 0.; ///< [rad]
    WaveProfileParameters profile;
    EnvelopeParameters envelope;

    void
    add_parameters(Declarations &declarations);
  };

  /**
   * A wave with any number n of waves on the body that runs to the tail (sigma = -1) or to the head (sigma = +1):
   *
   *   m = window(s) ramp(t) [ offset + A p( n s/L - sigma f t + phase/(2 pi) ) ],
   *
   * with the profile p (wave_entries.h), and f = n |c|/L if the wave speed c is given. The period is 1/f; with a ramp
   * there is none. A square wave of frequency 0 jumps at fixed places, one of wave number 0 at fixed times; the jumps
   * of others move, so no list holds them. Square waves that change in time have no rate.
   */
  class TravellingWave : public KnownStress
  {
  public:
    /// Throws InputError if fronts or window do not fit, if a speed is given for wave number 0, or if there are more
    /// than 1e8 periods (1e6 if the whole body is switched at once).
    TravellingWave(const TravellingWaveParameters &parameters, double length, double end_time);

    /// Reports jumps that move.
    void
    report(std::ostream &out) const override;

    std::unique_ptr<const ActiveStress>
    with_fronts(double part) const override;

  private:
    bool
    has_moving_jumps() const
    {
      return profile_.jumps() && phase_rate_ != 0. && wave_number_ > 0. && parameters_.amplitude != 0.;
    }

    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;
    std::unique_ptr<ActiveStressAtPoints>
    sine_at(const std::vector<double> &points, bool rate) const;

    const TravellingWaveParameters parameters_;
    const double length_, end_time_;
    const double wave_number_; ///< per length: n/L
    const double phase_rate_;  ///< -sigma f [periods/time]
    const double start_;       ///< phase/(2 pi) [periods]
    const WaveProfile profile_;
    const Window window_;
    const Ramp ramp_;
  };

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
   * A wave with fixed nodes:
   *
   *   m = window(s) ramp(t) [ offset + A cos( 2 pi n s/L + phase in space ) p( f t + phase/(2 pi) ) ],
   *
   * with the profile p (wave_entries.h). The period is 1/f; with a ramp there is none. A square wave, which jumps, has
   * no rate.
   */
  class StandingWave : public KnownStress
  {
  public:
    /// Throws InputError if fronts or window do not fit, or if there are more than 1e8 periods (1e6 of a square wave).
    StandingWave(const StandingWaveParameters &parameters, double length, double end_time);

  private:
    std::unique_ptr<ActiveStressAtPoints>
    evaluator(const std::vector<double> &points, bool rate) const override;

    const StandingWaveParameters parameters_;
    const double length_;
    const double start_; ///< phase/(2 pi) [periods]
    const WaveProfile profile_;
    const Window window_;
    const Ramp ramp_;
  };
} // namespace crawler
