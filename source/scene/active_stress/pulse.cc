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
    const std::string pulse_section = "Active stress/Pulse/";

    /// Multiple of its width beyond which a Gaussian is below round-off of its top, 2e-16.
    constexpr double gaussian_reach = 6.;
    /// Arguments where the bumps are steepest.
    constexpr double gaussian_steepest = 0.70710678118654752, compact_steepest = 0.75983568565159254;

    /// Returns of_value b(z) + of_slope b'(z).
    double
    bump(const bool compact, const double z, const double of_value, const double of_slope)
    {
      if (!compact)
        return std::exp(-z * z) * (of_value - 2. * z * of_slope);
      const double room = (1. - z) * (1. + z);
      if (!(room > 1e-3)) // there the bump is below 1e-400
        return 0.;
      return std::exp(1. - 1. / room) * (of_value - 2. * z / (room * room) * of_slope);
    }
  } // namespace

  void
  PulseParameters::add_parameters(Declarations &declarations)
  {
    declarations.choice("Shape", shape, {"gaussian", "compact"})
      .means("Shape of the pulse as a function of the distance z from its centre in widths: exp(-z^2), or exp(1 - "
             "1/(1-z^2)) for |z| < 1 and 0 beyond.");
    declarations.number("Amplitude", amplitude, any_number(), "force")
      .means("Active stress at the centre of the pulse.");
    declarations.number("Width", width, positive(), "length").means("Width of the pulse, see Shape.");
    declarations.number("Start position", start_position, any_number(), "length")
      .means("Place of the centre of the pulse at t = 0, which may be outside the body. Automatic: far enough outside "
             "that the pulse enters the body without a jump.");
    declare_direction(direction, declarations);
    declarations.number("Speed", speed, not_negative(), "length/time")
      .means("Speed of the pulse; with 0 it stays in place.");
    declarations.number("Repetition period", repetition_period, not_negative(), "time")
      .means("Time from one pulse to the next; 0 for a single pulse.");
    envelope.add_parameters(declarations);
  }

  Pulse::Pulse(const PulseParameters &parameters, const double length, const double end_time)
    : compact_(parameters.shape == "compact")
    , amplitude_(parameters.amplitude)
    , width_(parameters.width)
    , reach_(width_ * (compact_ ? 1. : gaussian_reach))
    , velocity_(sign_of(parameters.direction) * parameters.speed)
    , period_(parameters.repetition_period)
    , start_(parameters.start_position.value_or(sign_of(parameters.direction) > 0. ? -reach_ : length + reach_))
    , length_(length)
    , window_(parameters.envelope, pulse_section, length)
    , ramp_{parameters.envelope.ramp_duration}
  {
    require_reachable_body(end_time);
    if (amplitude_ != 0. && period_ != 0.)
      facts_.repetition = {period_, ramp_.end};
    facts_.breaks_in_space = window_.breaks();
  }

  /// Throws InputError if pulses are too narrow, overlap too much, or a single one never reaches the body.
  void
  Pulse::require_reachable_body(const double end_time) const
  {
    const double min_width = 1e-4 * length_;
    if (width_ < min_width)
      refuse(pulse_section + "Width",
             "the pulse is {:g} wide, but at least {:g} is expected, a ten-thousandth of the body",
             width_,
             min_width);
    if (period_ > 0.)
    {
      const double distance = std::abs(velocity_) * period_;
      if (!(distance >= width_ && std::isfinite(distance)))
        refuse(pulse_section + "Repetition period",
               "the pulses follow each other at a distance of {:g}, the speed times the "
               "repetition period, but at least their width, {:g}, is expected",
               distance,
               width_);
      require_countable_periods(1. / period_, end_time, false, pulse_section + "Repetition period");
      return;
    }
    const double end = start_ + velocity_ * end_time;
    if (std::max(start_, end) <= -reach_ || std::min(start_, end) >= length_ + reach_)
      refuse(pulse_section + (velocity_ == 0. ? "Start position" : "Speed"),
             "the pulse goes from {:g} to {:g} until the end time, but a path that reaches the "
             "body, from 0 to {:g}, is expected",
             start_,
             end,
             length_);
  }

  std::unique_ptr<ActiveStressAtPoints>
  Pulse::evaluator(const std::vector<double> &points, const bool rate) const
  {
    std::vector<double> window;
    for (const double s : points)
      window.push_back(window_.value(s));
    return stress_at_points([this, rate, points, window](const double t, const std::span<double> m) {
      std::fill(m.begin(), m.end(), 0.);
      const double ramp = ramp_.value(t), grow = ramp_.rate(t);
      const double of_value = amplitude_ * (rate ? grow : ramp);
      const double of_slope = rate ? -amplitude_ * ramp * velocity_ / width_ : 0.;
      const double P        = period_;
      double centre         = start_ + velocity_ * (P > 0. ? t - P * std::floor(t / P) : t);
      double last = centre, distance = 1.;
      if (P > 0.)
      {
        // Pulses from the first that reaches the body to the last.
        distance = std::abs(velocity_) * P;
        centre += distance * std::ceil((-reach_ - centre) / distance);
        last = length_ + reach_;
      }
      for (; centre <= last; centre += distance)
        for (std::size_t i = 0; i < m.size(); ++i)
          if (const double y = points[i] - centre; std::abs(y) < reach_)
            m[i] += bump(compact_, y / width_, of_value, of_slope);
      for (std::size_t i = 0; i < m.size(); ++i)
        m[i] *= window[i];
    });
  }

  /// Bounds from all pulses that reach the box, each where it is steepest.
  std::optional<ActiveStress::Bounds>
  Pulse::bounds(const Box &box) const
  {
    const double v = velocity_, P = period_, reach = reach_;
    const double A = std::abs(amplitude_);
    Bounds sum{0., 0.};
    const auto add_pulse = [&](const double start) {
      const double a = start + v * box.t_from, b = start + v * box.t_to;
      const double from = box.s_from - std::max(a, b), to = box.s_to - std::min(a, b);
      if (from >= reach || to <= -reach)
        return;
      // The largest |b'(z)| is at |z| = steepest, and falls off on both sides.
      const double steepest = compact_ ? compact_steepest : gaussian_steepest;
      const double least    = from <= 0. && to >= 0. ? 0. : std::min(std::abs(from), std::abs(to)) / width_;
      const double most     = std::max(std::abs(from), std::abs(to)) / width_;
      const double slope    = std::abs(bump(compact_, std::clamp(steepest, least, most), 0., 1.));
      sum.value += A * bump(compact_, least, 1., 0.);
      sum.rate += A * std::abs(v) / width_ * slope;
    };
    if (!(P > 0.))
      add_pulse(start_);
    else
    {
      // Range of the pulses j in the box: others have left, or have not arrived.
      const double d = v * P, x[] = {start_ + v * box.t_from, start_ + v * box.t_to};
      double first = HUGE_VAL, last = -HUGE_VAL;
      for (const double place : x)
        for (const double s : {box.s_from - reach, box.s_to + reach})
        {
          first = std::min(first, (place - s) / d);
          last  = std::max(last, (place - s) / d);
        }
      first = std::ceil(first);
      // Over long times the same pulses recur.
      const double on_the_body = std::ceil((box.s_to - box.s_from + 2. * reach) / std::abs(d)) + 1.;
      last                     = std::min(std::floor(last), first + 2. * on_the_body);
      for (double j = first; j <= last; ++j)
        add_pulse(start_ - j * d);
    }
    return ramp_.ramped(sum, box.t_from, box.t_to);
  }

  void
  Pulse::report(std::ostream &out) const
  {
    out << fmt::format("Pulse: from s = {:g} at t = 0 with velocity {:g}", start_, velocity_);
    if (period_ > 0.)
      out << fmt::format(", the next one {:g} behind it", std::abs(velocity_) * period_);
    out << '\n';
  }
} // namespace crawler
