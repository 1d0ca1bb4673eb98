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

    class AtPoints : public ActiveStressAtPoints
    {
    public:
      AtPoints(const StandingWave::Settings &wave, const std::vector<double> &points, const bool rate)
        : wave_(wave)
        , rate_(rate)
      {
        for (const double s : points)
        {
          window_.push_back(wave.envelope.window(s));
          cosine_.push_back(window_.back() * std::cos(wave.wave_number * s + wave.start_in_space));
        }
      }

      void
      values(const double t, const std::span<double> m) override
      {
        const double turns = wave_.frequency * t, x = turns - std::floor(turns) + wave_.start;
        const double ramp = wave_.envelope.ramp(t), p = wave_.profile.value(x);
        double offset = ramp * wave_.offset, factor = ramp * wave_.amplitude * p;
        if (rate_)
        {
          const double grow = wave_.envelope.ramp_rate(t);
          offset            = grow * wave_.offset;
          factor            = wave_.amplitude * (grow * p + ramp * wave_.frequency * wave_.profile.rate(x));
        }
        for (std::size_t i = 0; i < m.size(); ++i)
          m[i] = offset * window_[i] + factor * cosine_[i];
      }

    private:
      const StandingWave::Settings wave_;
      const bool rate_;
      std::vector<double> window_, cosine_;
    };
  } // namespace


  void
  StandingWaveParameters::add_parameters(Declarations &declarations)
  {
    declarations.enter("Standing wave");
    declarations.number("Amplitude", amplitude, any_number(), "Amplitude of the active stress.", "force");
    declarations.number("Offset", offset, any_number(), "What is added to the wave.", "force");
    declarations.number("Wave number",
                        wave_number,
                        {.lower = 0., .upper = 1000., .lower_included = true, .upper_included = true},
                        "Number n of waves on the body, not only whole ones: the stress is proportional to "
                        "cos(2 pi n s/L + phase in space); with 0 the whole body acts at once.",
                        "1");
    declarations.number("Phase in space",
                        phase_in_space,
                        any_number(),
                        "Phase of the cosine at s = 0, in radians; -pi/2 makes it a sine.",
                        "1");
    declarations.number("Frequency",
                        frequency,
                        {.lower = 0., .lower_included = true},
                        "Frequency f; with 0 the stress does not change.",
                        "1/time");
    declarations.number("Phase", phase, any_number(), "Phase of the oscillation at t = 0, in radians.", "1");
    profile.add_parameters(declarations);
    envelope.add_parameters(declarations);
    declarations.leave();
  }

  StandingWave::StandingWave(const StandingWaveParameters &parameters, const double length, const double end_time)
    : end_time_(end_time)
    , settings_{parameters.amplitude,
                parameters.offset,
                2. * pi * parameters.wave_number / length,
                parameters.phase_in_space,
                parameters.frequency,
                parameters.phase / (2. * pi),
                WaveProfile(parameters.profile, section),
                Envelope(parameters.envelope, section, length)}
  {
    require_countable_periods(settings_.frequency, end_time, settings_.profile.jumps(), section + "Frequency");
  }

  std::unique_ptr<ActiveStressAtPoints>
  StandingWave::at(const std::vector<double> &points) const
  {
    return std::make_unique<AtPoints>(settings_, points, false);
  }

  std::unique_ptr<ActiveStressAtPoints>
  StandingWave::rate_at(const std::vector<double> &points) const
  {
    if (settings_.profile.jumps() && settings_.frequency > 0.)
      return nullptr;
    return std::make_unique<AtPoints>(settings_, points, true);
  }

  std::optional<double>
  StandingWave::stride() const
  {
    if (settings_.amplitude == 0. || settings_.frequency == 0.)
      return std::nullopt;
    return 1. / settings_.frequency;
  }

  std::optional<double>
  StandingWave::period() const
  {
    return settings_.envelope.has_ramp() ? std::nullopt : stride();
  }

  std::vector<double>
  StandingWave::breaks_in_space() const
  {
    return settings_.envelope.breaks_in_space();
  }

  std::vector<double>
  StandingWave::breaks_in_time() const
  {
    return times_of_jumps(settings_.profile, settings_.frequency, settings_.start, end_time_);
  }
} // namespace crawler
