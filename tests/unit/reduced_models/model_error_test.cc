// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The estimated errors of the approximate levels against the nonlinear model.
#include "../../support/test.h"
#include "../../verification/random_scenes.h"

#include <crawler/reduced_models/kinematic.h>
#include <crawler/reduced_models/perturbation.h>
#include <crawler/reduced_models/reduced_scene.h>

using namespace crawler;

namespace
{
  ModelErrors
  errors_of(const test::Settings &settings)
  {
    const Scene scene = test::parameters_with(settings).create_scene();
    return ReducedScene(scene).model_errors();
  }
} // namespace

/// theory.md, section 5: the estimates cover the errors, and are not more than three times as large.
TEST(ModelError, FigS1)
{
  const std::pair<double, double> full[] = {
    {0.05, 1.2505153917e-3}, {0.1, 5.020242991e-3}, {0.2, 2.04422750e-2}, {0.3, 4.764510e-2}, {-0.1, 5.043148e-3}};
  for (const auto &[chi, D] : full)
  {
    const ModelErrors errors = errors_of(test::wave(-1., chi));
    ASSERT_TRUE(errors.known);
    const double is = std::abs(0.5 * chi * chi - D);
    EXPECT_GE(errors.perturbation, is) << "chi = " << chi;
    EXPECT_LE(errors.perturbation, 3. * is) << "chi = " << chi;
  }
  EXPECT_GE(errors_of(test::wave(-1., 0.2)).kinematic, 2.064390e-2 - 2.04422750e-2);
}

/// The corrections change the displacement by terms of order chi^3, chi^4 and chi^5, if the next order is not far.
TEST(ModelError, OrdersOfTheCorrections)
{
  const ModelErrors small = errors_of(test::wave(-2., 0.005, 1.3, 0.8)),
                    large = errors_of(test::wave(-2., 0.01, 1.3, 0.8));
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_NEAR(std::log2(large.changes[i] / small.changes[i]), 3. + i, 0.2) << "correction " << i + 1;
}

/// For a = 0 there is nothing to correct.
TEST(ModelError, VanishesForAEqualToZero)
{
  const ModelErrors errors = errors_of(test::wave(0., 0.3));
  ASSERT_TRUE(errors.known);
  EXPECT_LE(errors.perturbation, 1e-14);
  EXPECT_LE(errors.kinematic, 1e-14);
}

TEST(ModelError, NotKnownWhereTheBodyInverts)
{
  EXPECT_FALSE(errors_of(test::wave(-1., 0.6)).known);
}

/// Optimal waves, computed with the nonlinear model to 1e-6 of the displacement.
TEST(ModelError, RandomWaves)
{
  std::vector<double> ratios;
  for (unsigned int number = 0; number < 60; ++number)
  {
    const auto wave = test::random_scene(test::Family::smooth, number);
    if (wave.kind != "optimal wave")
      continue;
    const auto truth         = test::run_with(test::with(wave.settings, "Accuracy = 1e-6"), {}).result;
    const ModelErrors errors = errors_of(wave.settings);
    if (truth.time.status != Status::finished || !errors.known)
      continue;
    const Scene scene = test::parameters_with(wave.settings).create_scene();
    const ReducedScene levels(scene);
    const double D = truth.displacement / levels.units.length, of_truth = 2e-6 * std::abs(D) + 1e-15;
    const double series = std::abs(perturbation::displacement(*levels.wave, 1.) - D);
    const double motion = std::abs(kinematic(levels.scene, *levels.strain, 1e-8).displacement - D);
    EXPECT_LE(series, errors.perturbation + of_truth) << number;
    EXPECT_LE(motion, errors.kinematic + of_truth) << number;
    ratios.push_back(errors.perturbation / series);
  }
  ASSERT_GE(ratios.size(), 15u);
  EXPECT_LE(test::quantile(ratios, 0.5), 3.);
}
