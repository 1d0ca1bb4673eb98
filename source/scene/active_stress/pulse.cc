// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/pulse.h>
#include <crawler/scene/active_stress/wave_entries.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ostream>

namespace crawler
{
  namespace
  {
    const std::string section = "Active stress/Pulse/";

    /// Beyond this multiple of its width a Gaussian is below round-off of its top, 2e-16.
    constexpr double gaussian_reach = 6.;
    /// Where the bumps are the steepest.
    constexpr double gaussian_steepest = 0.70710678118654752, compact_steepest = 0.75983568565159254;

    /// |b'(z)|
    double
    slope_of_bump(const bool compact, const double z)
    {
      if (!compact)
        return 2. * z * std::exp(-z * z);
      const double room = (1. - z) * (1. + z);
      return room > 1e-3 ? 2. * z / (room * room) * std::exp(1. - 1. / room) : 0.;
    }

    class AtPoints : public ActiveStressAtPoints
    {
    public:
      AtPoints(const Pulse::Settings &pulse, const std::vector<double> &points, const bool rate)
        : pulse_(pulse)
        , rate_(rate)
        , points_(points)
      {
        for (const double s : points)
          window_.push_back(pulse.envelope.window(s));
      }

      void
      values(const double t, const std::span<double> m) override
      {
        std::fill(m.begin(), m.end(), 0.);
        const double ramp = pulse_.envelope.ramp(t), grow = pulse_.envelope.ramp_rate(t);
        const double of_value = pulse_.amplitude * (rate_ ? grow : ramp);
        const double of_slope = rate_ ? -pulse_.amplitude * ramp * pulse_.velocity / pulse_.width : 0.;
        const double P        = pulse_.period;
        double centre         = pulse_.start + pulse_.velocity * (P > 0. ? t - P * std::floor(t / P) : t);
        double last = centre, distance = 1.;
        if (P > 0.)
        {
          // From the first pulse that reaches the body to the last.
          distance = std::abs(pulse_.velocity) * P;
          centre += distance * std::ceil((-pulse_.reach - centre) / distance);
          last = pulse_.length + pulse_.reach;
        }
        for (; centre <= last; centre += distance)
          for (std::size_t i = 0; i < m.size(); ++i)
            if (const double y = points_[i] - centre; std::abs(y) < pulse_.reach)
              m[i] += bump(y / pulse_.width, of_value, of_slope);
        for (std::size_t i = 0; i < m.size(); ++i)
          m[i] *= window_[i];
      }

    private:
      /// of_value b(z) + of_slope b'(z)
      double
      bump(const double z, const double of_value, const double of_slope) const
      {
        if (!pulse_.compact)
          return std::exp(-z * z) * (of_value - 2. * z * of_slope);
        const double room = (1. - z) * (1. + z);
        if (!(room > 1e-3)) // where it is below 1e-400
          return 0.;
        return std::exp(1. - 1. / room) * (of_value - 2. * z / (room * room) * of_slope);
      }

      const Pulse::Settings pulse_;
      const bool rate_;
      const std::vector<double> points_;
      std::vector<double> window_;
    };

    Pulse::Settings
    settings_of(const PulseParameters &parameters, const double length)
    {
      const bool compact   = parameters.shape == "compact";
      const double reach   = parameters.width * (compact ? 1. : gaussian_reach);
      const double sign    = sign_of(parameters.direction);
      const double outside = sign > 0. ? -reach : length + reach;
      return {compact,
              parameters.amplitude,
              parameters.width,
              parameters.start_position.value_or(outside),
              sign * parameters.speed,
              parameters.repetition_period,
              reach,
              length,
              Envelope(parameters.envelope, section, length)};
    }
  } // namespace


  void
  PulseParameters::add_parameters(Declarations &declarations)
  {
    const Range not_negative{.lower = 0., .lower_included = true};
    declarations.enter("Pulse");
    declarations.choice("Shape",
                        shape,
                        {"gaussian", "compact"},
                        "The bump over its distance z from the centre in widths: exp(-z^2), or "
                        "exp(1 - 1/(1-z^2)) for |z| < 1 and 0 beyond.");
    declarations.number("Amplitude", amplitude, any_number(), "Active stress in the middle of the pulse.", "force");
    declarations.number("Width", width, positive(), "Width of the pulse, see Shape.", "length");
    declarations.number(
      "Start position",
      start_position,
      any_number(),
      "Where the middle of the pulse is at t = 0, also outside of the body; automatic: so far outside "
      "that it comes to the body without a jump.",
      "length");
    declare_direction(direction, declarations);
    declarations.number("Speed", speed, not_negative, "Speed of the pulse; with 0 it stays.", "length/time");
    declarations.number("Repetition period",
                        repetition_period,
                        not_negative,
                        "Time from one pulse to the next; 0 for a single pulse.",
                        "time");
    envelope.add_parameters(declarations);
    declarations.leave();
  }

  Pulse::Pulse(const PulseParameters &parameters, const double length, const double end_time)
    : settings_(settings_of(parameters, length))
  {
    const double least_width = 1e-4 * length;
    if (settings_.width < least_width)
      throw InputError(
        fmt::format("the pulse is {:g} wide, but at least {:g} is expected, a ten thousandth of the body",
                    settings_.width,
                    least_width),
        section + "Width");
    if (settings_.period > 0.)
    {
      const double distance = std::abs(settings_.velocity) * settings_.period;
      if (!(distance >= settings_.width && std::isfinite(distance)))
        throw InputError(fmt::format("the pulses follow each other at a distance of {:g}, the speed times the "
                                     "repetition period, but at least their width, {:g}, is expected",
                                     distance,
                                     settings_.width),
                         section + "Repetition period");
      require_countable_periods(1. / settings_.period, end_time, false, section + "Repetition period");
      return;
    }
    const double end = settings_.start + settings_.velocity * end_time;
    if (std::max(settings_.start, end) <= -settings_.reach ||
        std::min(settings_.start, end) >= length + settings_.reach)
      throw InputError(fmt::format("the pulse goes from {:g} to {:g} until the end time, but a way that comes to the "
                                   "body, from 0 to {:g}, is expected",
                                   settings_.start,
                                   end,
                                   length),
                       section + (settings_.velocity == 0. ? "Start position" : "Speed"));
  }

  std::unique_ptr<ActiveStressAtPoints>
  Pulse::at(const std::vector<double> &points) const
  {
    return std::make_unique<AtPoints>(settings_, points, false);
  }

  std::unique_ptr<ActiveStressAtPoints>
  Pulse::rate_at(const std::vector<double> &points) const
  {
    return std::make_unique<AtPoints>(settings_, points, true);
  }

  std::optional<double>
  Pulse::stride() const
  {
    if (settings_.amplitude == 0. || settings_.period == 0.)
      return std::nullopt;
    return settings_.period;
  }

  std::optional<double>
  Pulse::period() const
  {
    return settings_.envelope.has_ramp() ? std::nullopt : stride();
  }

  /// Of all pulses that come to the box, each where it is the steepest.
  std::optional<ActiveStress::Bounds>
  Pulse::bounds(const Box &box) const
  {
    const double v = settings_.velocity, P = settings_.period, reach = settings_.reach;
    const double A    = std::abs(settings_.amplitude);
    const double grow = settings_.envelope.largest_ramp_rate(box.t_from, box.t_to);
    Bounds sum{0., 0.};
    const auto add_pulse = [&](const double start) {
      const double a = start + v * box.t_from, b = start + v * box.t_to;
      const double from = box.s_from - std::max(a, b), to = box.s_to - std::min(a, b);
      if (from >= reach || to <= -reach)
        return;
      // The largest |b'(z)| is at |z| = steepest, and falls on both sides of it.
      const double steepest = settings_.compact ? compact_steepest : gaussian_steepest;
      const double least    = from <= 0. && to >= 0. ? 0. : std::min(std::abs(from), std::abs(to)) / settings_.width;
      const double most     = std::max(std::abs(from), std::abs(to)) / settings_.width;
      const double slope    = slope_of_bump(settings_.compact, std::clamp(steepest, least, most));
      sum.value += A;
      sum.rate += A * (std::abs(v) / settings_.width * slope + grow);
    };
    if (!(P > 0.))
      add_pulse(settings_.start);
    else
    {
      // Pulse j has left or not come yet unless j is between these.
      const double d = v * P, x[] = {settings_.start + v * box.t_from, settings_.start + v * box.t_to};
      double first = HUGE_VAL, last = -HUGE_VAL;
      for (const double place : x)
        for (const double s : {box.s_from - reach, box.s_to + reach})
        {
          first = std::min(first, (place - s) / d);
          last  = std::max(last, (place - s) / d);
        }
      first = std::ceil(first);
      // In a long time the same pulses come again and again.
      const double on_the_body = std::ceil((box.s_to - box.s_from + 2. * reach) / std::abs(d)) + 1.;
      last                     = std::min(std::floor(last), first + 2. * on_the_body);
      for (double j = first; j <= last; ++j)
        add_pulse(settings_.start - j * d);
    }
    return sum;
  }

  std::vector<double>
  Pulse::breaks_in_space() const
  {
    return settings_.envelope.breaks_in_space();
  }

  void
  Pulse::report(std::ostream &out) const
  {
    out << fmt::format("Pulse: from s = {:g} at t = 0 with velocity {:g}", settings_.start, settings_.velocity);
    if (settings_.period > 0.)
      out << fmt::format(", the next one {:g} behind it", std::abs(settings_.velocity) * settings_.period);
    out << '\n';
  }
} // namespace crawler
