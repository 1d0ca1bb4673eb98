// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/accuracy/extrapolation.h>
#include <crawler/mesh/reference_element.h>

using namespace crawler;

/// The weights of the value at 0 sum to 1 and take x, x^2, ... to 0: polynomials are extrapolated exactly.
TEST(Extrapolation, IsExactForPolynomials)
{
  const std::vector<double> x = {0.8, 0.4, 0.2, 0.1}, weights = interpolation_matrix(x, {0.});
  for (int power = 0; power < 4; ++power)
  {
    double sum = 0.;
    for (std::size_t k = 0; k < x.size(); ++k)
      sum += weights[k] * std::pow(x[k], power);
    EXPECT_NEAR(sum, power == 0 ? 1. : 0., 1e-13);
  }
}

/// Displacement and all energies are combined, and what one result lacks stays that of the last.
TEST(Extrapolation, CombinesResults)
{
  const Scene scene                       = test::parameters_with({}).create_scene();
  const SimulationResult coarse           = test::run_with(test::wave(-1., 0.3)).result;
  SimulationResult fine                   = test::run_with(test::wave(-1., 0.35)).result;
  const SimulationResult *const results[] = {&coarse, &fine};
  const double weights[]                  = {-1., 2.};
  const SimulationResult sum              = combined(scene, results, weights);
  EXPECT_DOUBLE_EQ(sum.displacement, 2. * fine.displacement - coarse.displacement);
  for (const auto energy : EnergyBalance::energies())
  {
    const double before = (*coarse.energy_balance).*energy, last = (*fine.energy_balance).*energy;
    EXPECT_DOUBLE_EQ((*sum.energy_balance).*energy, 2. * last - before);
  }
  EXPECT_NE(sum.energy_balance->stress_work, fine.energy_balance->stress_work);
  EXPECT_LT(sum.energy_balance->residual(), 1e-4);
  fine.energy_balance.reset();
  EXPECT_FALSE(combined(scene, results, weights).energy_balance);
}
