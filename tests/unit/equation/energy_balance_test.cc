// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/observed_order.h"

#include <crawler/equation/energy_balance.h>

#include <fmt/format.h>
#include <gtest/gtest.h>

using namespace crawler;

namespace
{
  /// Error of int_0^1 exp(t) sin(5t) dt with n steps of uneven size.
  double
  quadrature_error(const unsigned int n)
  {
    const auto f = [](const double t) { return std::exp(t) * std::sin(5. * t); };
    RateQuadrature quadrature;
    double sum = 0.;
    // As a time integrator does: from tiny steps, each half as long again as the one before, to those of size 1/n.
    quadrature.advance(0., {{f(0.), 0., 0., 0., 0.}});
    for (double small = 1e-6 / n; small < 0.4 / n; small *= 1.5)
    {
      quadrature.advance(small, {{f(small), 0., 0., 0., 0.}});
      sum += quadrature.until(1.)[0];
    }
    for (unsigned int i = 1; i <= n; ++i)
    {
      const double x = static_cast<double>(i) / n, t = x + 0.05 * std::sin(6. * x) * (1. - x);
      {
        quadrature.advance(t, {{f(t), 0., 0., 0., 0.}});
        sum += quadrature.until(1.)[0];
      }
    }
    const double exact = (std::exp(1.) * (std::sin(5.) - 5. * std::cos(5.)) + 5.) / 26.;
    return std::abs(sum - exact);
  }
} // namespace

TEST(RateQuadrature, IsExactForPolynomialsOfDegreeFive)
{
  RateQuadrature quadrature;
  double sum = 0.;
  // The first steps have fewer points: start where they contribute nothing.
  for (const double t : {-1e-12, -8e-13, -6e-13, -4e-13, -2e-13, 0.})
    quadrature.advance(t, {{0., 0., 0., 0., 0.}});
  RateQuadrature fresh;
  std::vector<double> times = {1., 1.1, 1.25, 1.3, 1.45, 1.6, 1.7, 1.9, 2.};
  for (std::size_t i = 0; i < times.size(); ++i)
  {
    const double t = times[i];
    fresh.advance(t, {{6. * std::pow(t, 5), 0., 0., 0., 0.}});
    const double increment = fresh.until(1.)[0];
    if (i >= 5)
      sum += increment - (std::pow(t, 6) - std::pow(times[i - 1], 6));
  }
  EXPECT_NEAR(sum, 0., 1e-11);
}

/// The stages of a step as short as round-off of the time, and integrals to places within a step.
TEST(RateQuadrature, IntegratesBetweenStages)
{
  RateQuadrature quadrature;
  for (const double size : {0.3, 1e-16})
  {
    quadrature.begin_step(size);
    for (const double place : {0.2, 0.6, 1.})
      quadrature.add_stage(place, {{3. * place * place, 1., 0., 0., 0.}});
    for (const double place : {0., 0.25, 1.})
    {
      EXPECT_NEAR(quadrature.until(place)[0], size * std::pow(place, 3), 1e-14 * size);
      EXPECT_NEAR(quadrature.until(place)[1], size * place, 1e-14 * size);
    }
  }
}

TEST(RateQuadrature, ConvergesWithOrderSix)
{
  std::vector<double> n, errors;
  for (const unsigned int i : {15u, 30u, 60u})
  {
    n.push_back(i);
    errors.push_back(quadrature_error(i));
  }
  EXPECT_GE(test::observed_order("quadrature", n, errors), 5.3);
}

TEST(EnergyBalance, ResidualIsRelativeToTheExchangedWork)
{
  EnergyBalance energy_balance;
  EXPECT_EQ(energy_balance.residual(), 0.); // a body at rest
  energy_balance.stress_work    = 1.;
  energy_balance.dissipation    = 0.7;
  energy_balance.elastic_energy = 0.2;
  energy_balance.exchanged_work = 2.;
  energy_balance.end_work       = -0.5;
  EXPECT_NEAR(energy_balance.residual(), 0.05, 1e-15);
  EXPECT_EQ(energy_balance.paper_energy(), 0.5);
}
