// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/scene/active_stress/profile.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

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
      throw InputError(fmt::format("the fronts are {:g} of a period wide, but at most {:g} is expected for the duty "
                                   "cycle {:g}",
                                   front,
                                   most,
                                   duty),
                       section + "Front width");
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
} // namespace crawler
