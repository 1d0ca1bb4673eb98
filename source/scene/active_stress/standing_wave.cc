// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/standing_wave.h>

#include <cmath>
#include <numbers>

namespace crawler
{
  namespace
  {
    const std::string section = "Active stress/Standing wave/";
    constexpr double pi       = std::numbers::pi;
  } // namespace


  void
  StandingWaveParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Standing wave");
    declarations.number("Amplitude", amplitude, any_number(), "force").means("Amplitude of the active stress.");
    declarations.number("Offset", offset, any_number(), "force").means("What is added to the wave.");
    declarations
      .number(
        "Wave number", wave_number, {.lower = 0., .upper = 1000., .lower_included = true, .upper_included = true}, "1")
      .means("Number n of waves on the body, not only whole ones: the stress is proportional to cos(2 pi n s/L + phase "
             "in space); with 0 the whole body acts at once.");
    declarations.number("Phase in space", phase_in_space, any_number(), "1")
      .means("Phase of the cosine at s = 0, in radians; -pi/2 makes it a sine.");
    declarations.number("Frequency", frequency, {.lower = 0., .lower_included = true}, "1/time")
      .means("Frequency f; with 0 the stress does not change.");
    declarations.number("Phase", phase, any_number(), "1").means("Phase of the oscillation at t = 0, in radians.");
    profile.add_parameters(declarations);
    envelope.add_parameters(declarations);
    declarations.leave();
  }

  StandingWave::StandingWave(const StandingWaveParameters &parameters, const double length, const double end_time)
    : amplitude_(parameters.amplitude)
    , offset_(parameters.offset)
    , wave_number_(2. * pi * parameters.wave_number / length)
    , start_in_space_(parameters.phase_in_space)
    , frequency_(parameters.frequency)
    , start_(parameters.phase / (2. * pi))
    , profile_(parameters.profile, section)
    , envelope_(parameters.envelope, section, length)
  {
    require_countable_periods(frequency_, end_time, profile_.jumps(), section + "Frequency");
    if (amplitude_ != 0. && frequency_ != 0.)
      set_stride(1. / frequency_, envelope_.has_ramp());
    facts_.has_rate        = !(profile_.jumps() && frequency_ > 0.);
    facts_.breaks_in_space = envelope_.breaks_in_space();
    facts_.breaks_in_time  = times_of_jumps(profile_, frequency_, start_, end_time);
  }

  std::unique_ptr<ActiveStressAtPoints>
  StandingWave::evaluator(const std::vector<double> &points, const bool rate) const
  {
    std::vector<double> window, cosine;
    for (const double s : points)
    {
      window.push_back(envelope_.window(s));
      cosine.push_back(window.back() * std::cos(wave_number_ * s + start_in_space_));
    }
    return stress_at_points([this, rate, window, cosine](const double t, const std::span<double> m) {
      const double turns = frequency_ * t, x = turns - std::floor(turns) + start_;
      const double ramp = envelope_.ramp(t), p = profile_.value(x);
      double offset = ramp * offset_, factor = ramp * amplitude_ * p;
      if (rate)
      {
        const double grow = envelope_.ramp_rate(t);
        offset            = grow * offset_;
        factor            = amplitude_ * (grow * p + ramp * frequency_ * profile_.rate(x));
      }
      for (std::size_t i = 0; i < m.size(); ++i)
        m[i] = offset * window[i] + factor * cosine[i];
    });
  }
} // namespace crawler
