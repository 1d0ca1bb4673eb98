// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/accuracy/extrapolation.h>

using namespace crawler;

/// The weights sum to 1 and take x, x^2, ... to 0: polynomials are extrapolated exactly.
TEST(Extrapolation, IsExactForPolynomials)
{
  const std::vector<double> x = {0.8, 0.4, 0.2, 0.1}, weights = weights_at_zero(x);
  for (int power = 0; power < 4; ++power)
  {
    double sum = 0.;
    for (std::size_t k = 0; k < x.size(); ++k)
      sum += weights[k] * std::pow(x[k], power);
    EXPECT_NEAR(sum, power == 0 ? 1. : 0., 1e-13);
  }
}

/// Displacement and works are combined, an energy balance that closes still does, and what one result lacks stays that
/// of the last.
TEST(Extrapolation, CombinesResults)
{
  const Scene scene                       = test::parameters_with({}).create_scene();
  SimulationResult coarse                 = test::run_with(test::wave(-1., 0.3)).result;
  SimulationResult fine                   = coarse;
  coarse.displacement                     = 1.;
  fine.displacement                       = 2.;
  const SimulationResult *const results[] = {&coarse, &fine};
  const double weights[]                  = {-1., 2.};
  const SimulationResult sum              = combined(scene, results, weights);
  EXPECT_DOUBLE_EQ(sum.displacement, 3.);
  EXPECT_NEAR(sum.energy_balance->stress_work, fine.energy_balance->stress_work, 1e-15);
  EXPECT_LT(sum.energy_balance->residual(), 1e-4);
  coarse.energy_balance.reset();
  EXPECT_EQ(combined(scene, results, weights).energy_balance->stress_work, fine.energy_balance->stress_work);
}
