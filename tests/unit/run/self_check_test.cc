// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Made-up results, and which of them are failures; and the scenes whose gait has a bound.
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/run/gait_efficiency.h>
#include <crawler/run/result_table.h>
#include <crawler/run/self_check.h>

using namespace crawler;

namespace
{
  /// A run with the stretches 0.7 to 1.3, whose works balance.
  SimulationResult
  made_up(const double displacement)
  {
    SimulationResult result;
    result.time.status       = Status::finished;
    result.displacement      = displacement;
    result.stretch.min.value = 0.7;
    result.stretch.max.value = 1.3;
    EnergyBalance &energies  = result.energy_balance.emplace();
    energies.stress_work     = 0.05;
    energies.exchanged_work  = 0.08;
    energies.elastic_energy  = 0.01;
    energies.dissipation     = 0.04;
    return result;
  }

  std::optional<double>
  gait_efficiency(const Scene &scene, SimulationResult result)
  {
    set_efficiencies(scene, result);
    return result.gait_efficiency;
  }
} // namespace

TEST(SelfCheck, NoGaitIsBetterThanTheBound)
{
  const Parameters parameters = test::parameters_with({});
  const double bound          = (1. / std::sqrt(1. / 1.3) - 1. / std::sqrt(1. / 0.7)) * std::sqrt(0.05);
  for (const double part : {0.9, 1.005, 1.02})
  {
    SimulationResult result = made_up(part * bound);
    result.gait_efficiency  = gait_efficiency(parameters.create_scene(), result);
    ASSERT_TRUE(result.gait_efficiency);
    EXPECT_NEAR(*result.gait_efficiency, part, 1e-12);
    check_identities(result, parameters);
    EXPECT_EQ(result.time.status, Status::finished) << "its error is not known";
    set_error_bound(result, "gait.efficiency", 0.01);
    check_identities(result, parameters);
    EXPECT_EQ(result.time.status, part > 1.01 ? Status::failed : Status::finished) << part;
    EXPECT_EQ(result.time.reason, part > 1.01 ? "gait_efficiency" : "");
  }
}

/// A body that starts stretched may have elastic energy to spend: the bound is that of its dissipation.
TEST(GaitEfficiency, CountsFromRestOrByDissipation)
{
  const Scene scene                     = test::parameters_with({}).create_scene();
  SimulationResult result               = made_up(0.03);
  const double from_rest                = *gait_efficiency(scene, result);
  result.energy_balance->initial_energy = 0.02;
  EXPECT_NEAR(*gait_efficiency(scene, result), from_rest * std::sqrt(0.05 / 0.04), 1e-12);
}

/// Of any friction law by its values; of a law that has its extreme inside of the stretches too.
TEST(GaitEfficiency, IsThatOfTheFrictionLaw)
{
  const auto efficiency = [](const test::Settings &settings) {
    return gait_efficiency(test::parameters_with(test::with(settings, "travelling wave")).create_scene(),
                           made_up(0.03));
  };
  const auto by_formula = [&](const std::string &formula) {
    return efficiency({{"Ground/Friction law", "expression"}, {"Ground/Expression", formula}});
  };
  const double power = *efficiency({{"Body/Friction coefficient", "1"}});
  EXPECT_NEAR(*by_formula("1/w"), power, 1e-12);
  EXPECT_NEAR(*efficiency({{"Body/Elastic modulus profile", "1+0.3*s"}}), power, 1e-12);
  EXPECT_NEAR(*efficiency({{"Body/Friction coefficient", "4"}}), 2. * power, 1e-12);
  const double D = 0.03 / std::sqrt(0.05);
  EXPECT_NEAR(*by_formula("1+(w-1)^2"), D / (1. - 1. / std::sqrt(1.09)), 1e-5);
  EXPECT_FALSE(by_formula("1"));
  EXPECT_FALSE(efficiency({{"Body/Anchoring exponent", "1"}}));
  EXPECT_FALSE(efficiency({{"Body/Friction profile", "1+0.3*s"}}));
  EXPECT_FALSE(efficiency({{"Ground/Profile", "1+0.1*tanh(x)"}}));
  EXPECT_FALSE(efficiency({{"Ground/Backward ratio", "3"}, {"Ground/Switching velocity", "0.2"}}));
}
