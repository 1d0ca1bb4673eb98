// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/travelling_wave.h>

#include <cmath>
#include <numbers>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string section = "Active stress/Travelling wave/";
    constexpr double pi       = std::numbers::pi;

    /// The sine with its parts of s and t apart: p = sin x cos theta + cos x sin theta, theta = 2 pi phase_rate t.
    class SineAtPoints : public ActiveStressAtPoints
    {
    public:
      SineAtPoints(const TravellingWave::Settings &wave, const std::vector<double> &points, const bool rate)
        : wave_(wave)
        , rate_(rate)
      {
        for (const double s : points)
        {
          const double x = 2. * pi * (wave.wave_number * s + wave.start), window = wave.envelope.window(s);
          window_.push_back(window);
          sine_.push_back(window * std::sin(x));
          cosine_.push_back(window * std::cos(x));
        }
      }

      void
      values(const double t, const std::span<double> m) override
      {
        const double turns = wave_.phase_rate * t, theta = 2. * pi * (turns - std::floor(turns));
        const double ramp = wave_.envelope.ramp(t), st = std::sin(theta), ct = std::cos(theta);
        double offset = ramp * wave_.offset, of_sine = ramp * wave_.amplitude * ct,
               of_cosine = ramp * wave_.amplitude * st;
        if (rate_)
        {
          const double turn = ramp * wave_.amplitude * 2. * pi * wave_.phase_rate, grow = wave_.envelope.ramp_rate(t);
          offset    = grow * wave_.offset;
          of_sine   = grow * wave_.amplitude * ct - turn * st;
          of_cosine = grow * wave_.amplitude * st + turn * ct;
        }
        for (std::size_t i = 0; i < m.size(); ++i)
          m[i] = offset * window_[i] + of_sine * sine_[i] + of_cosine * cosine_[i];
      }

    private:
      const TravellingWave::Settings wave_;
      const bool rate_;
      std::vector<double> window_, sine_, cosine_;
    };

    class SquareAtPoints : public ActiveStressAtPoints
    {
    public:
      SquareAtPoints(const TravellingWave::Settings &wave, const std::vector<double> &points, const bool rate)
        : wave_(wave)
        , rate_(rate)
      {
        for (const double s : points)
        {
          window_.push_back(wave.envelope.window(s));
          x_.push_back(wave.wave_number * s + wave.start);
        }
      }

      void
      values(const double t, const std::span<double> m) override
      {
        const double turns = wave_.phase_rate * t, x = turns - std::floor(turns), ramp = wave_.envelope.ramp(t);
        if (!rate_)
        {
          for (std::size_t i = 0; i < m.size(); ++i)
            m[i] = window_[i] * ramp * (wave_.offset + wave_.amplitude * wave_.profile.value(x_[i] + x));
          return;
        }
        const double grow = wave_.envelope.ramp_rate(t), turn = ramp * wave_.amplitude * wave_.phase_rate;
        for (std::size_t i = 0; i < m.size(); ++i)
        {
          const double value = grow == 0. ? 0. : wave_.offset + wave_.amplitude * wave_.profile.value(x_[i] + x);
          m[i]               = window_[i] * (grow * value + turn * wave_.profile.rate(x_[i] + x));
        }
      }

    private:
      const TravellingWave::Settings wave_;
      const bool rate_;
      std::vector<double> window_, x_;
    };

    std::unique_ptr<ActiveStressAtPoints>
    make(const TravellingWave::Settings &wave, const std::vector<double> &points, const bool rate)
    {
      if (wave.profile.is_sine())
        return std::make_unique<SineAtPoints>(wave, points, rate);
      return std::make_unique<SquareAtPoints>(wave, points, rate);
    }

    TravellingWave::Settings
    settings_of(const TravellingWaveParameters &parameters, const double length)
    {
      const double n = parameters.wave_number;
      double f       = parameters.frequency;
      if (parameters.given_by == "wave speed")
      {
        if (n == 0.)
          throw InputError("a wave of wave number 0 has no speed; a wave number that is not 0, or Given by = "
                           "frequency, is expected",
                           section + "Given by");
        f = parameters.wave_speed * n / length;
      }
      return {parameters.amplitude,
              parameters.offset,
              n / length,
              -sign_of(parameters.direction) * f,
              parameters.phase / (2. * pi),
              WaveProfile(parameters.profile, section),
              Envelope(parameters.envelope, section, length)};
    }
  } // namespace


  void
  TravellingWaveParameters::add_parameters(Declarations &declarations)
  {
    const Range not_negative{.lower = 0., .lower_included = true};
    declarations.enter("Travelling wave");
    declarations.number("Amplitude", amplitude, any_number(), "Amplitude of the active stress.", "force");
    declarations.number("Offset", offset, any_number(), "What is added to the wave.", "force");
    declarations.number("Wave number",
                        wave_number,
                        {.lower = 0., .upper = 1000., .lower_included = true, .upper_included = true},
                        "Number n of waves on the body, not only whole ones; with 0 the whole body acts at once.",
                        "1");
    declare_direction(direction, declarations);
    declarations.choice("Given by",
                        given_by,
                        {"frequency", "wave speed"},
                        "Which of the two says how fast the wave runs; frequency = wave number * wave speed/L.");
    declarations.number("Frequency",
                        frequency,
                        not_negative,
                        "Frequency f; with 0 the wave stands still. Used if given by frequency.",
                        "1/time");
    declarations.number("Wave speed",
                        wave_speed,
                        not_negative,
                        "Speed of the wave along the body. Used if given by wave speed.",
                        "length/time");
    declarations.number("Phase", phase, any_number(), "Phase of the wave at s = 0, t = 0, in radians.", "1");
    profile.add_parameters(declarations);
    envelope.add_parameters(declarations);
    declarations.leave();
  }

  TravellingWave::TravellingWave(const TravellingWaveParameters &parameters, const double length, const double end_time)
    : length_(length)
    , end_time_(end_time)
    , settings_(settings_of(parameters, length))
  {
    require_countable_periods(std::abs(settings_.phase_rate),
                              end_time,
                              settings_.profile.jumps() && settings_.wave_number == 0.,
                              section + (parameters.given_by == "frequency" ? "Frequency" : "Wave speed"));
  }

  std::unique_ptr<ActiveStressAtPoints>
  TravellingWave::at(const std::vector<double> &points) const
  {
    return make(settings_, points, false);
  }

  std::unique_ptr<ActiveStressAtPoints>
  TravellingWave::rate_at(const std::vector<double> &points) const
  {
    if (settings_.profile.jumps() && settings_.phase_rate != 0.)
      return nullptr;
    return make(settings_, points, true);
  }

  std::optional<double>
  TravellingWave::stride() const
  {
    if (settings_.amplitude == 0. || settings_.phase_rate == 0.)
      return std::nullopt;
    return 1. / std::abs(settings_.phase_rate);
  }

  std::optional<double>
  TravellingWave::period() const
  {
    return settings_.envelope.has_ramp() ? std::nullopt : stride();
  }

  std::vector<double>
  TravellingWave::breaks_in_space() const
  {
    std::vector<double> places = settings_.envelope.breaks_in_space();
    if (settings_.phase_rate == 0. && settings_.wave_number > 0.)
      for (const double x :
           settings_.profile.breaks(settings_.start, settings_.start + settings_.wave_number * length_))
      {
        const double s = (x - settings_.start) / settings_.wave_number;
        if (s > 0. && s < length_)
          places.push_back(s);
      }
    return places;
  }

  std::vector<double>
  TravellingWave::breaks_in_time() const
  {
    if (settings_.wave_number > 0.)
      return {};
    // A phase that runs backwards passes the mirrored jumps.
    if (settings_.phase_rate >= 0.)
      return times_of_jumps(settings_.profile, settings_.phase_rate, settings_.start, end_time_);
    std::vector<double> times;
    const double f = -settings_.phase_rate;
    for (const double x : settings_.profile.breaks(settings_.start - f * end_time_, settings_.start))
    {
      const double t = (settings_.start - x) / f;
      if (t > 0. && t < end_time_)
        times.push_back(t);
    }
    return times;
  }

  void
  TravellingWave::report(std::ostream &out) const
  {
    if (settings_.profile.jumps() && settings_.phase_rate != 0. && settings_.wave_number > 0. &&
        settings_.amplitude != 0.)
      out << "Travelling wave: the jumps of a square wave move through the cells of the mesh, which costs orders of "
             "convergence; Profile = smoothed square is recommended\n";
  }
} // namespace crawler
