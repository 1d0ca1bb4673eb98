// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>
#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/active_stress/wave_entries.h>

#include <string>

namespace crawler
{
  class Declarations;

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
   * A wave of any number n of waves on the body, that runs to the tail (sigma = -1) or to the head (sigma = +1):
   *
   *   m = window(s) ramp(t) [ offset + A p( n s/L - sigma f t + phase/(2 pi) ) ],
   *
   * with the profile p (wave_entries.h), and f = n |c|/L if the wave speed c is given. Its period is 1/f; with a ramp
   * it has none.
   */
  class TravellingWave : public ActiveStress
  {
  public:
    static constexpr const char *description = "a sine or square wave that runs along the body";

    /// Throws InputError if fronts or window do not fit, if a speed is given for wave number 0, or if there are more
    /// than 1e8 periods (1e6 if all of the body is switched at once).
    TravellingWave(const TravellingWaveParameters &parameters, double length, double end_time);

    std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const override;

    /// Null for a square wave that moves: it jumps everywhere.
    std::unique_ptr<ActiveStressAtPoints>
    rate_at(const std::vector<double> &points) const override;

    std::optional<double>
    period() const override;
    std::optional<double>
    stride() const override;

    /// Edges of the window, and the jumps of a square wave of frequency 0.
    std::vector<double>
    breaks_in_space() const override;

    /// The jumps of a square wave of wave number 0; those of others move, so that no list holds them.
    std::vector<double>
    breaks_in_time() const override;

    /// A word on jumps that move.
    void
    report(std::ostream &out) const override;

    struct Settings
    {
      double amplitude, offset;
      double wave_number; ///< per length: n/L
      double phase_rate;  ///< -sigma f [periods/time]
      double start;       ///< phase/(2 pi) [periods]
      WaveProfile profile;
      Envelope envelope;
    };

  private:
    const double length_, end_time_;
    const Settings settings_;
  };
} // namespace crawler
