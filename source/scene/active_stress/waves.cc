// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/waves.h>

#include <cmath>
#include <numbers>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string travelling_section = "Active stress/Travelling wave/",
                      standing_section   = "Active stress/Standing wave/";
    using std::numbers::pi;

    /// Frequency f [1/time].
    double
    frequency_of(const TravellingWaveParameters &parameters, const double length)
    {
      if (parameters.given_by == "frequency")
        return parameters.frequency;
      if (parameters.wave_number == 0.)
        throw InputError("a wave of wave number 0 has no speed; a wave number that is not 0, or Given by = "
                         "frequency, is expected",
                         travelling_section + "Given by");
      return parameters.wave_speed * parameters.wave_number / length;
    }
  } // namespace

  void
  TravellingWaveParameters::add_parameters(Declarations &declarations)
  {
    declarations.number("Amplitude", amplitude, any_number(), "force").means("Amplitude of the active stress.");
    declarations.number("Offset", offset, any_number(), "force").means("Constant that is added to the wave.");
    declarations.number("Wave number", wave_number, between(0., 1000.), "1")
      .means("Number n of waves on the body, not necessarily whole; with 0 the whole body acts at once.");
    declare_direction(direction, declarations);
    declarations.choice("Given by", given_by, {"frequency", "wave speed"})
      .means("Which of the two determines the speed of the wave; frequency = wave number * wave speed/L.");
    declarations.number("Frequency", frequency, not_negative(), "1/time")
      .means("Frequency f; with 0 the wave stands still. Used if given by frequency.");
    declarations.number("Wave speed", wave_speed, not_negative(), "length/time")
      .means("Speed of the wave along the body. Used if given by wave speed.");
    declarations.number("Phase", phase, any_number(), "1").means("Phase of the wave at s = 0, t = 0, in radians.");
    profile.add_parameters(declarations);
    envelope.add_parameters(declarations);
  }

  TravellingWave::TravellingWave(const TravellingWaveParameters &parameters, const double length, const double end_time)
    : parameters_(parameters)
    , length_(length)
    , end_time_(end_time)
    , wave_number_(parameters.wave_number / length)
    , phase_rate_(-sign_of(parameters.direction) * frequency_of(parameters, length))
    , start_(parameters.phase / (2. * pi))
    , profile_(parameters.profile, travelling_section)
    , window_(parameters.envelope, travelling_section, length)
    , ramp_{parameters.envelope.ramp_duration}
  {
    require_countable_periods(std::abs(phase_rate_),
                              end_time,
                              profile_.jumps() && wave_number_ == 0.,
                              travelling_section + (parameters.given_by == "frequency" ? "Frequency" : "Wave speed"));
    if (parameters.amplitude != 0. && phase_rate_ != 0.)
      facts_.repetition = {1. / std::abs(phase_rate_), ramp_.end};
    facts_.has_rate        = !(profile_.jumps() && phase_rate_ != 0.);
    facts_.breaks_in_space = window_.breaks();
    if (phase_rate_ == 0.)
      for (const double s : times_of_jumps(profile_, wave_number_, start_, length))
        facts_.breaks_in_space.push_back(s);
    if (wave_number_ == 0.)
      facts_.breaks_in_time = times_of_jumps(profile_, phase_rate_, start_, end_time);
  }

  /// Evaluates a sine with separate factors of s and t: p = sin x cos theta + cos x sin theta, theta = 2 pi phase_rate
  /// t.
  std::unique_ptr<ActiveStressAtPoints>
  TravellingWave::sine_at(const std::vector<double> &points, const bool rate) const
  {
    std::vector<double> windows, sine, cosine;
    for (const double s : points)
    {
      const double x = 2. * pi * (wave_number_ * s + start_), window = window_.value(s);
      windows.push_back(window);
      sine.push_back(window * std::sin(x));
      cosine.push_back(window * std::cos(x));
    }
    return stress_at_points([this, rate, windows, sine, cosine](const double t, const std::span<double> m) {
      const double A = parameters_.amplitude, turns = phase_rate_ * t, theta = 2. * pi * (turns - std::floor(turns));
      const double ramp = ramp_.value(t), st = std::sin(theta), ct = std::cos(theta);
      double offset = ramp * parameters_.offset, of_sine = ramp * A * ct, of_cosine = ramp * A * st;
      if (rate)
      {
        const double turn = ramp * A * 2. * pi * phase_rate_, grow = ramp_.rate(t);
        offset    = grow * parameters_.offset;
        of_sine   = grow * A * ct - turn * st;
        of_cosine = grow * A * st + turn * ct;
      }
      for (std::size_t i = 0; i < m.size(); ++i)
        m[i] = offset * windows[i] + of_sine * sine[i] + of_cosine * cosine[i];
    });
  }

  std::unique_ptr<ActiveStressAtPoints>
  TravellingWave::evaluator(const std::vector<double> &points, const bool rate) const
  {
    if (profile_.is_sine())
      return sine_at(points, rate);
    std::vector<double> window, x;
    for (const double s : points)
    {
      window.push_back(window_.value(s));
      x.push_back(wave_number_ * s + start_);
    }
    return stress_at_points([this, rate, window, x](const double t, const std::span<double> m) {
      const double turns = phase_rate_ * t, phase = turns - std::floor(turns), ramp = ramp_.value(t);
      const double grow = ramp_.rate(t), A = parameters_.amplitude, offset = parameters_.offset,
                   turn = ramp * A * phase_rate_;
      for (std::size_t i = 0; i < m.size(); ++i)
        if (!rate)
          m[i] = window[i] * ramp * (offset + A * profile_.value(x[i] + phase));
        else
        {
          const double value = grow == 0. ? 0. : offset + A * profile_.value(x[i] + phase);
          m[i]               = window[i] * (grow * value + turn * profile_.rate(x[i] + phase));
        }
    });
  }

  std::unique_ptr<const ActiveStress>
  TravellingWave::with_fronts(const double part) const
  {
    if (!has_moving_jumps())
      return nullptr;
    TravellingWaveParameters smooth = parameters_;
    smooth.profile.profile          = "smoothed square";
    smooth.profile.front_width      = part * std::min(smooth.profile.duty_cycle, 1. - smooth.profile.duty_cycle);
    return std::make_unique<TravellingWave>(smooth, length_, end_time_);
  }

  void
  TravellingWave::report(std::ostream &out) const
  {
    if (has_moving_jumps())
      out << "Travelling wave: the jumps of a square wave move through the cells of the mesh; its answer is that of "
             "waves with ever steeper fronts, which costs more than Profile = smoothed square\n";
  }

  void
  StandingWaveParameters::add_parameters(Declarations &declarations)
  {
    declarations.number("Amplitude", amplitude, any_number(), "force").means("Amplitude of the active stress.");
    declarations.number("Offset", offset, any_number(), "force").means("Constant that is added to the wave.");
    declarations.number("Wave number", wave_number, between(0., 1000.), "1")
      .means("Number n of waves on the body, not necessarily whole: the stress is proportional to cos(2 pi n s/L + "
             "phase in space); with 0 the whole body acts at once.");
    declarations.number("Phase in space", phase_in_space, any_number(), "1")
      .means("Phase of the cosine at s = 0, in radians; -pi/2 makes it a sine.");
    declarations.number("Frequency", frequency, not_negative(), "1/time")
      .means("Frequency f; with 0 the stress does not change.");
    declarations.number("Phase", phase, any_number(), "1").means("Phase of the oscillation at t = 0, in radians.");
    profile.add_parameters(declarations);
    envelope.add_parameters(declarations);
  }

  StandingWave::StandingWave(const StandingWaveParameters &parameters, const double length, const double end_time)
    : parameters_(parameters)
    , length_(length)
    , start_(parameters.phase / (2. * pi))
    , profile_(parameters.profile, standing_section)
    , window_(parameters.envelope, standing_section, length)
    , ramp_{parameters.envelope.ramp_duration}
  {
    const double f = parameters.frequency;
    require_countable_periods(f, end_time, profile_.jumps(), standing_section + "Frequency");
    if (parameters.amplitude != 0. && f != 0.)
      facts_.repetition = {1. / f, ramp_.end};
    facts_.has_rate        = !(profile_.jumps() && f > 0.);
    facts_.breaks_in_space = window_.breaks();
    facts_.breaks_in_time  = times_of_jumps(profile_, f, start_, end_time);
  }

  std::unique_ptr<ActiveStressAtPoints>
  StandingWave::evaluator(const std::vector<double> &points, const bool rate) const
  {
    const double q = 2. * pi * parameters_.wave_number / length_;
    std::vector<double> window, cosine;
    for (const double s : points)
    {
      window.push_back(window_.value(s));
      cosine.push_back(window.back() * std::cos(q * s + parameters_.phase_in_space));
    }
    return stress_at_points([this, rate, window, cosine](const double t, const std::span<double> m) {
      const double A = parameters_.amplitude, f = parameters_.frequency, turns = f * t,
                   x    = turns - std::floor(turns) + start_;
      const double ramp = ramp_.value(t), p = profile_.value(x);
      double offset = ramp * parameters_.offset, factor = ramp * A * p;
      if (rate)
      {
        const double grow = ramp_.rate(t);
        offset            = grow * parameters_.offset;
        factor            = A * (grow * p + ramp * f * profile_.rate(x));
      }
      for (std::size_t i = 0; i < m.size(); ++i)
        m[i] = offset * window[i] + factor * cosine[i];
    });
  }
} // namespace crawler
