// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/parameters/declarations.h>
#include <crawler/scene/active_stress/wave_entries.h>
#include <crawler/scene/breaks.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace crawler
{
  double
  smooth_step(const double x)
  {
    if (!(x > 0.))
      return 0.;
    if (x >= 1.)
      return 1.;
    return 1. / (1. + std::exp(1. / x - 1. / (1. - x)));
  }

  double
  smooth_step_rate(const double x)
  {
    const double y = 1. - x;
    if (!(x > 0. && y > 0.))
      return 0.;
    const double z = 1. / x - 1. / y; // S (1-S) = 1/(2 cosh(z/2))^2
    if (std::abs(z) > 700.)
      return 0.;
    const double half = 0.5 / std::cosh(0.5 * z);
    return half * half * (1. / (x * x) + 1. / (y * y));
  }

  double
  largest_smooth_step_rate(const double from, const double to)
  {
    return smooth_step_rate(std::clamp(0.5, from, to)); // its only maximum is in the middle
  }

  double
  smooth_step_inverse(const double value)
  {
    const double z = std::log(1. / value - 1.); // = 1/x - 1/(1-x), a quadratic equation for x
    return 2. / (z + 2. + std::sqrt(z * z + 4.));
  }

  Switching::Switching(const double duty, const double front, const std::string &section)
    : duty_(duty)
    , front_(front)
  {
    const double most = std::min(duty, 1. - duty);
    if (front > most * (1. + 1e-12))
      refuse(section + "Front width",
             "the fronts are {:g} of a period wide, but at most {:g} is expected for the duty "
             "cycle {:g}",
             front,
             most,
             duty);
  }

  double
  Switching::value(double x) const
  {
    x -= std::floor(x);
    if (front_ == 0.)
      return x < duty_ ? 1. : 0.;
    // The front about 0 is split between both ends of [0, 1).
    if (x > 1. - 0.5 * front_)
      x -= 1.;
    return x < 0.5 * duty_ ? smooth_step(x / front_ + 0.5) : smooth_step((duty_ - x) / front_ + 0.5);
  }

  double
  Switching::rate(double x) const
  {
    if (front_ == 0.)
      return 0.;
    x -= std::floor(x);
    if (x > 1. - 0.5 * front_)
      x -= 1.;
    return (x < 0.5 * duty_ ? smooth_step_rate(x / front_ + 0.5) : -smooth_step_rate((duty_ - x) / front_ + 0.5)) /
           front_;
  }

  std::vector<double>
  Switching::breaks(const double from, const double to) const
  {
    std::vector<double> list;
    if (front_ > 0.)
      return list;
    for (double n = std::floor(from); n < to; ++n)
      for (const double x : {n, n + duty_})
        if (x > from && x < to)
          list.push_back(x);
    return list;
  }

  void
  WaveProfileParameters::add_parameters(Declarations &declarations)
  {
    declarations.choice("Profile", profile, {"sine", "square", "smoothed square"})
      .means("How the stress changes within a period: as a sine, or between +1 and -1 times the amplitude, by jumps or "
             "by smooth fronts.");
    declarations.number("Duty cycle", duty_cycle, {.lower = 0., .upper = 1.}, "1")
      .means("Share of the period in which a square profile is +1. Not used by the sine.");
    declarations.number("Front width", front_width, {.lower = 0., .upper = 0.5, .upper_included = true}, "1")
      .means("Width of each front of the smoothed square as a share of the period.");
  }

  WaveProfile::WaveProfile(const WaveProfileParameters &parameters, const std::string &section)
  {
    if (parameters.profile != "sine")
      switching_.emplace(parameters.duty_cycle, parameters.profile == "square" ? 0. : parameters.front_width, section);
  }

  double
  WaveProfile::value(const double x) const
  {
    return switching_ ? 2. * switching_->value(x) - 1. : std::sin(2. * std::numbers::pi * x);
  }

  double
  WaveProfile::rate(const double x) const
  {
    constexpr double q = 2. * std::numbers::pi;
    return switching_ ? 2. * switching_->rate(x) : q * std::cos(q * x);
  }

  namespace
  {
    const std::string to_head = "from tail to head";
  }

  void
  declare_direction(std::string &direction, Declarations &declarations)
  {
    declarations.choice("Direction", direction, {"from head to tail", to_head})
      .means("Direction in which it runs; the head is at s = L, the tail at s = 0.");
  }

  double
  sign_of(const std::string &direction)
  {
    return direction == to_head ? 1. : -1.;
  }

  void
  require_countable_periods(const double frequency, const double end_time, const bool jumps, const std::string &entry)
  {
    const double most = jumps ? 1e6 : 1e8;
    if (!(frequency * end_time <= most))
      refuse(entry,
             "the stress has {:.3g} periods until the end time, but at most {:g} are expected{}",
             frequency * end_time,
             most,
             jumps ? " if it jumps in each of them" : "");
  }

  std::vector<double>
  times_of_jumps(const WaveProfile &profile, const double frequency, const double start, const double end_time)
  {
    std::vector<double> times;
    const double end = start + frequency * end_time;
    if (frequency != 0.)
      for (const double x : profile.breaks(std::min(start, end), std::max(start, end)))
        times.push_back((x - start) / frequency);
    return within(std::move(times), end_time);
  }
} // namespace crawler
