// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/grid_samples.h>
#include <crawler/scene/friction_law.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace crawler
{
  namespace
  {
    /// w^n by repeated squaring.
    inline double
    integer_power(double w, unsigned int n)
    {
      double result = 1.;
      for (; n > 0; n >>= 1, w *= w)
        if (n & 1)
          result *= w;
      return result;
    }

    /// Stretches at which to look for the extremes of g: both ends, where g is monotone.
    std::vector<double>
    stretches(const FrictionLaw &friction, const double from, const double to)
    {
      return equal_parts(from, to, dynamic_cast<const PowerFriction *>(&friction) != nullptr ? 1 : 1024);
    }
  } // namespace

  double
  FrictionLaw::value(const double w) const
  {
    double g = 0.;
    values({&w, 1}, {&g, 1});
    return g;
  }

  double
  FrictionLaw::exponent(const double w) const
  {
    double g = 0., w_dg = 0.;
    values({&w, 1}, {&g, 1}, {&w_dg, 1});
    return w_dg / g;
  }

  PowerFriction::PowerFriction(const double gamma, const double a, const bool its_is_power_law)
    : FrictionLaw(its_is_power_law)
    , gamma_(gamma)
    , a_(a)
    , a_is_small_integer_(a == std::round(a) && std::abs(a) <= 64)
  {
  }

  void
  PowerFriction::values(const std::span<const double> w, const std::span<double> g, const std::span<double> w_dg) const
  {
    if (a_is_small_integer_)
    {
      const auto n = static_cast<unsigned int>(std::abs(a_));
      for (std::size_t i = 0; i < w.size(); ++i)
        g[i] = gamma_ * integer_power(a_ < 0 ? 1. / w[i] : w[i], n);
    }
    else
      for (std::size_t i = 0; i < w.size(); ++i)
        g[i] = gamma_ * std::pow(w[i], a_);
    for (std::size_t i = 0; i < w_dg.size(); ++i)
      w_dg[i] = a_ == 0. ? 0. : a_ * g[i];
  }

  double
  largest_merit(const FrictionLaw &friction, const double from, const double to)
  {
    constexpr double smallest_range = 1e-8; // ranges below are round-off of the stretches
    const std::vector<double> w     = stretches(friction, from, to);
    std::vector<double> g(w.size());
    friction.values(w, g);
    const auto [least, most] = std::minmax_element(g.begin(), g.end());
    const double largest = 1. / std::sqrt(*least), F = largest - 1. / std::sqrt(*most);
    return F > smallest_range * largest ? F : 0.;
  }

  std::optional<double>
  stretch_without_friction(const FrictionLaw &friction, const double from, const double to)
  {
    const std::vector<double> w = stretches(friction, from, to);
    std::vector<double> g(w.size());
    friction.values(w, g);
    for (std::size_t i = 0; i < w.size(); ++i)
      if (!(g[i] > 0.) || !std::isfinite(g[i]))
        return w[i];
    return std::nullopt;
  }
} // namespace crawler
