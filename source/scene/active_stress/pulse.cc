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
