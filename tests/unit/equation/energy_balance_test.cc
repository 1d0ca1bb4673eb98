// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/equation/energy_balance.h>

using namespace crawler;

TEST(RateQuadrature, IsExactForPolynomialsOfDegreeFive)
{
  double sum = 0.;
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
