// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Numbers of doc/theory.md, section "The optimal wave" (gamma = k = L = 1, a = -1, a_1 = 1 unless stated).
#include "../../support/test.h"
#include "../../support/wave_energy.h"

#include <crawler/base/exceptions.h>
#include <crawler/scene/active_stress/optimal_wave.h>

using namespace crawler;

namespace
{
  const WaveShape one_harmonic{{1.}, {0.}};

  void
  expect_speeds(const double end_time, const double energy, const std::vector<double> &expected)
  {
    const WaveRoots found = find_wave_roots(Body(), one_harmonic, 0.1, end_time, energy);
    ASSERT_EQ(found.roots.size(), expected.size()) << "H = " << energy;
    EXPECT_TRUE(found.complete);
    EXPECT_FALSE(found.double_roots);
    for (std::size_t i = 0; i < expected.size(); ++i)
      EXPECT_NEAR(found.roots[i].speed, expected[i], 5e-7) << "H = " << energy << ", root " << i + 1;
  }
} // namespace

TEST(WaveRoots, CheckValues)
{
  expect_speeds(1., 0.6, {0.907364, 1.114664, 1.806458, 2.252322, 2.678413});
  expect_speeds(1., 1., {0.806762});
  expect_speeds(1., 5., {0.469199});
}

TEST(WaveRoots, ManyRootsAllFound)
{
  const WaveRoots found = find_wave_roots(Body(), one_harmonic, 0.1, 20., 10.1);
  EXPECT_EQ(found.roots.size(), 125u);
  EXPECT_NEAR(found.roots.front().speed, 0.049750, 5e-7);
  EXPECT_TRUE(found.complete);
}

TEST(WaveRoots, EveryRootSpendsTheEnergy)
{
  Body body;
  body.length               = 2.;
  body.elastic_modulus      = 3.;
  body.friction_coefficient = 0.7;
  body.anchoring_exponent   = 3.;
  const WaveShape shape{{1., 0., 0.3}, {0.2, 0.5, 0.}};
  const double T        = 4.;
  const double smallest = find_wave_roots(body, shape, 0.1, T, 1.).smallest_energy;
  const WaveRoots found = find_wave_roots(body, shape, 0.1, T, 1.2 * smallest);
  EXPECT_GT(found.roots.size(), 5u);
  for (const WaveRoot &root : found.roots)
  {
    EXPECT_NEAR(test::wave_energy(body, shape, T, root.speed) / (1.2 * smallest), 1., 1e-12);
    // c = a/(L gamma alpha)
    EXPECT_NEAR(
      root.speed * body.length * body.friction_coefficient * root.multiplier, body.friction_exponent(), 1e-12);
  }
}

/// H = 2 L gamma T Delta_2 in both of the paper's parameter sets: every root is a double one, cT/L = j.
TEST(WaveRoots, DoubleRootsOfThePaper)
{
  for (const auto &[T, H] : {std::pair<double, double>{1., 0.5}, {20., 10.}})
  {
    const WaveRoots found = find_wave_roots(Body(), one_harmonic, 0.4, T, H);
    EXPECT_TRUE(found.double_roots);
    EXPECT_FALSE(found.complete);
    ASSERT_GE(found.roots.size(), 25u);
    for (unsigned int j = 1; j <= found.roots.size(); ++j)
    {
      EXPECT_NEAR(found.roots[j - 1].speed * T, j, 1e-9);
      EXPECT_NEAR(found.roots[j - 1].multiplier, -T / j, 1e-9); // alpha_j = a T/(j L^2 gamma)
    }
  }
}

TEST(WaveRoots, DoubleRootsOfHigherHarmonicsOnly)
{
  // Harmonics 2 and 4 vanish together at x = j/2.
  const WaveRoots found = find_wave_roots(Body(), {{0., 1., 0., 0.5}, {0., 0., 0., 0.}}, 0.1, 1., 2. * 1.25 / 4.);
  EXPECT_TRUE(found.double_roots);
  ASSERT_GE(found.roots.size(), 3u);
  EXPECT_NEAR(found.roots[0].speed, 0.5, 1e-12);
  EXPECT_NEAR(found.roots[2].speed, 1.5, 1e-12);
}

TEST(WaveRoots, NoneBelowTheSmallestEnergyOrAboveTheLargest)
{
  const WaveRoots below = find_wave_roots(Body(), one_harmonic, 0.1, 1., 0.49);
  EXPECT_TRUE(below.roots.empty());
  EXPECT_DOUBLE_EQ(below.smallest_energy, 0.5);
  // One harmonic: H_max = 2 L gamma T Delta_2 + k L q^2 T^2 P/4.
  const double largest = 0.5 + 4. * std::numbers::pi * std::numbers::pi / 4.;
  EXPECT_NEAR(below.largest_energy, largest, 1e-12);
  EXPECT_TRUE(find_wave_roots(Body(), one_harmonic, 0.1, 1., largest * 1.0001).roots.empty());
  EXPECT_EQ(find_wave_roots(Body(), one_harmonic, 0.1, 1., largest * 0.9999).roots.size(), 1u);
}

TEST(WaveRoots, SmallExcessEnergyHasVeryManyRootsAndEnds)
{
  const WaveRoots found = find_wave_roots(Body(), one_harmonic, 0.1, 1., 0.5 * (1. + 1e-9));
  EXPECT_GE(found.roots.size(), 25u);
  EXPECT_FALSE(found.complete);
  EXPECT_FALSE(found.double_roots);
}

TEST(WaveRoots, LeadingOrderStretchAndDirection)
{
  // Strain amplitude 2 chi a_1/c, displacement -2 a T Delta_2 chi^2/c at whole cT/L.
  const WaveRoot worm = describe_wave(Body(), one_harmonic, 0.4, 20., 1.);
  EXPECT_NEAR(worm.min_stretch, 0.2, 1e-12);
  EXPECT_NEAR(worm.max_stretch, 1.8, 1e-12);
  EXPECT_NEAR(worm.displacement, 1.6, 1e-12);
  EXPECT_TRUE(worm.admissible());
  const WaveRoot slow = describe_wave(Body(), one_harmonic, 0.4, 20., 0.05);
  EXPECT_NEAR(slow.max_stretch - 1., 16., 1e-9); // the paper's own choice for its Fig. 2
  EXPECT_FALSE(slow.admissible());
  // Motion to +s: a < 0 has c > 0 and a > 0 has c < 0.
  Body snail;
  snail.anchoring_exponent = 0.;
  for (const WaveRoot &root : find_wave_roots(snail, one_harmonic, 0.1, 1., 0.6).roots)
  {
    EXPECT_LT(root.speed, 0.);
    EXPECT_GT(root.displacement, 0.);
  }
  for (const WaveRoot &root : find_wave_roots(Body(), one_harmonic, 0.1, 1., 0.6).roots)
    EXPECT_GT(root.displacement, 0.);
}

TEST(OptimalWave, ChoosesByRuleAndIndex)
{
  OptimalWaveParameters parameters;
  parameters.energy = 10.;
  EXPECT_NEAR(OptimalWave(parameters, Body(), 20.).wave().speed, 0.85, 1e-12); // largest admissible displacement
  parameters.root = "largest displacement";
  EXPECT_NEAR(OptimalWave(parameters, Body(), 20.).wave().speed, 0.05, 1e-12);
  parameters.root       = "index";
  parameters.root_index = 20;
  const OptimalWave fig_2(parameters, Body(), 20.);
  EXPECT_NEAR(fig_2.wave().speed, 1., 1e-12);
  EXPECT_NEAR(fig_2.wave().multiplier, -1., 1e-12);
  std::ostringstream report;
  fig_2.report(report);
  EXPECT_NE(report.str().find("double roots"), std::string::npos);
  EXPECT_NE(report.str().find("inadmissible"), std::string::npos);
  EXPECT_NE(report.str().find("<- chosen"), std::string::npos);
}
