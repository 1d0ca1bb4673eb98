// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Gait numbers of runs against theory.md: sections 4, 5 and 10.
#include "../support/run_text.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

using namespace crawler;

namespace
{
  SimulationResult
  stride(test::Settings settings, const bool with_cycle_stop = false)
  {
    settings.emplace_back("Accuracy", "1e-8");
    const Simulation::Options options{
      .ledger = true, .cycles = with_cycle_stop ? std::optional(CycleWish{1., 1e-8}) : std::nullopt, .gait = true};
    return test::run_with(settings, options).result;
  }
} // namespace

TEST(GaitNumbers, ThoseOfFigure2)
{
  const auto result = stride(test::wave(-1., 0.4, 1., 20.));
  ASSERT_TRUE(result.gait);
  const Gait &gait = *result.gait;
  EXPECT_DOUBLE_EQ(gait.period, 1.);
  EXPECT_DOUBLE_EQ(gait.n_strides, 20.);
  // "first cycle 0.090073, each later cycle 0.090100"
  EXPECT_NEAR(gait.displacement, 0.090100, 0.5e-6);
  EXPECT_NEAR(gait.displacement, (1.801968240 - 9.0072529800e-2) / 19., 2e-9);
  EXPECT_STREQ(gait.direction(), "retrograde");
  EXPECT_NEAR(gait.wave->speed, -1., 0.01);
  // From stride to stride nothing is stored: the work is dissipated.
  EXPECT_NEAR(gait.ledger->elastic_energy, 0., 1e-9);
  EXPECT_NEAR(gait.ledger->stress_power, gait.ledger->dissipation, 1e-8);
  EXPECT_NEAR(gait.ledger->stress_power, (1.674733 - 0.083860120) / 19., 1e-6);
  EXPECT_LT(*result.gait_efficiency, 1.);
  EXPECT_NEAR(*gait.slip(), 1. - 0.0901, 1e-3);

  const auto early = stride(test::wave(-1., 0.4, 1., 20.), /*with_cycle_stop=*/true);
  ASSERT_TRUE(early.cycles && early.gait);
  EXPECT_NEAR(early.gait->displacement, gait.displacement, 1e-8);
  EXPECT_NEAR(early.gait->ledger->positive_power, gait.ledger->positive_power, 1e-5); // kinks
}

TEST(GaitNumbers, TheDirectionSwitchesWithA)
{
  for (const double a : {-1., 1.})
  {
    const auto result = stride(test::wave(a, 0.05, a < 0. ? 1. : -1., 2.));
    ASSERT_TRUE(result.gait);
    EXPECT_STREQ(result.gait->direction(), a < 0. ? "retrograde" : "prograde");
    EXPECT_GT(result.gait->displacement, 0.);
    // -L gamma c/a to leading order in chi.
    EXPECT_NEAR(*result.gait->cost_of_transport(result.gait->ledger->stress_power), 1., 0.02);
  }
  // The centre of mass stays where it is, so nothing is prograde or retrograde.
  const auto still = stride(test::wave(0., 0.1, 1., 2.));
  EXPECT_STREQ(still.gait->direction(), "none");
  EXPECT_FALSE(still.gait->cost_of_transport(1.));
  EXPECT_FALSE(still.gait_efficiency);
}

TEST(GaitNumbers, TheEnergiesOfAStrideAddUpWithThoseBefore)
{
  const double T   = 2.3; // the last stride starts where no cycle ends
  const auto whole = stride(test::wave(-1., 0.3, 1., T)), before = stride(test::wave(-1., 0.3, 1., T - 1.));
  EXPECT_NEAR(whole.gait->displacement, whole.displacement - before.displacement, 1e-9);
  EXPECT_NEAR(whole.gait->ledger->stress_power, whole.ledger->stress_power - before.ledger->stress_power, 1e-8);
  EXPECT_NEAR(whole.gait->ledger->positive_power, whole.ledger->positive_power - before.ledger->positive_power, 1e-4);
}
