// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The generator "two-level wave" against theory.md, "Gait efficiency": its strain, its share, what it reaches on the
// kinematic level and in the nonlinear model, and what it refuses.
#include "../../support/expect_near.h"
#include "../../support/stress.h"
#include "../../support/test.h"

using namespace crawler;
using test::Settings;

namespace
{
  const std::string section = "Active stress/Two-level wave/";

  Settings
  two_level_wave(const double a, const std::string &own, const Settings &others = {})
  {
    return test::with(test::set("p = {}; two-level wave; {}", 1. - a, own), others);
  }

  TwoLevelWave::Numbers
  numbers(const Settings &settings)
  {
    const Scene scene = test::parameters_with(settings).create_scene();
    return dynamic_cast<const TwoLevelWave &>(*scene.active_stress).numbers();
  }

  void
  expect_complaint(const std::string &own,
                   const std::string &entry,
                   const std::string &part,
                   const Settings &others = {})
  {
    test::expect_complaint(two_level_wave(-1., own, others), {section + entry + ": ", part});
  }
} // namespace

TEST(TwoLevelWave, HasItsTwoStrains)
{
  const std::string own = "Smallest strain = -0.2; Largest strain = 0.5; Share = 0.3";
  const Scene scene     = test::parameters_with(two_level_wave(-1., own, {{"Body/Length", "2"}})).create_scene();
  std::vector<double> e(6);
  const auto strain = scene.active_stress->prescribed_strain()->at({0., 0.06, 0.54, 0.6, 0.66, 1.94});
  strain->values(/*t=*/0., e); // the fronts are about s = 0 and s = 0.3 L, 0.05 L wide
  test::expect_near(e, {0.15, 0.5, 0.5, 0.15, -0.2, -0.2}, 1e-14);
  scene.active_stress->prescribed_strain()->at({1.})->values(/*t=*/0.75, {e.data(), 1}); // from head to tail
  EXPECT_NEAR(e[0], 0.5, 1e-14);
  EXPECT_NEAR(scene.active_stress->period().value_or(0.), 1., 1e-14);
}

TEST(TwoLevelWave, TheBestShareIsThatOfTheTheory)
{
  for (const double a : {-1., 2.})
  {
    const auto best = numbers(two_level_wave(a, "Front width = 1e-3"));
    EXPECT_NEAR(best.share, 1. / (1. + std::pow(1.3 / 0.7, 0.5 * a)), 1e-14);
    EXPECT_NEAR(best.bound, a < 0. ? 0.303515 : 0.659341, 5e-7);
    EXPECT_NEAR(best.merit, best.bound, 1e-3 * best.bound);
    for (const double other : {0.9 * best.share, 1.1 * best.share})
      EXPECT_LT(numbers(two_level_wave(a, "Front width = 1e-3; Share = " + test::text(other))).merit, best.merit)
        << other;
  }
}

/// What the kinematic level measures is what the wave says of itself, close to the bound and never above. The waves of
/// a = -1 run against the motion, those of a = 2 with it.
TEST(TwoLevelWave, NearlyReachesTheBound)
{
  for (const auto &[a, front, to_head] :
       {std::tuple(-1., 0.05, false), {-1., 0.1, true}, {2., 0.05, true}, {2., 0.1, false}})
  {
    const Settings settings = two_level_wave(
      a, fmt::format("Front width = {}; Direction = {}", front, to_head ? "from tail to head" : "from head to tail"));
    const auto result = test::on_level(settings);
    const auto own    = numbers(settings);
    ASSERT_TRUE(result.gait_efficiency);
    EXPECT_GT(*result.gait_efficiency, front < 0.07 ? 0.97 : 0.95) << a << " " << front;
    EXPECT_LT(*result.gait_efficiency, 1.);
    EXPECT_NEAR(*result.gait_efficiency, own.merit / own.bound, 1e-6);
    EXPECT_EQ(result.displacement > 0., to_head == (a > 0.)) << a;
  }
}

/// Friction in proportion to the velocity on the ground, g = w, is a = 1; and the best share of a law that is no power.
TEST(TwoLevelWave, OnOtherGrounds)
{
  const Settings newtonian = {{"Ground/Friction law", "Newtonian"}}, power = {{"Body/Anchoring exponent", "0"}};
  EXPECT_NEAR(numbers(two_level_wave(1., "", newtonian)).share, numbers(two_level_wave(1., "", power)).share, 1e-14);
  EXPECT_NEAR(numbers(two_level_wave(1., "", newtonian)).merit, numbers(two_level_wave(1., "", power)).merit, 1e-14);
  const auto on_expression = [](const std::string &own) {
    return two_level_wave(-1.,
                          "Front width = 0.05; " + own,
                          test::set("gamma = 2; Ground/Friction law = expression; Ground/Expression = 0.7/(0.2+w^2)"));
  };
  const auto result = test::on_level(on_expression(""));
  const auto own    = numbers(on_expression(""));
  EXPECT_GT(*result.gait_efficiency, 0.97);
  EXPECT_LT(*result.gait_efficiency, 1.);
  EXPECT_NEAR(*result.gait_efficiency, own.merit / own.bound, 1e-6);
  for (const double other : {0.9 * own.share, 1.1 * own.share})
    EXPECT_LT(numbers(on_expression("Share = " + test::text(other))).merit, own.merit) << other;
}

TEST(TwoLevelWave, DoesTheWorkThatIsGiven)
{
  const Settings body = test::set("L = 3; gamma = 0.4; k = 7; T = 1.7");
  const auto result =
    test::on_level(two_level_wave(-1., "Given by = work; Work = 0.25; Wave number = 2; Phase = 0.7", body));
  EXPECT_NEAR(result.energy_balance->stress_work, 0.25, 1e-6 * 0.25);
  const auto by_speed = numbers(two_level_wave(-1., "Given by = wave speed; Wave speed = 0.6; Wave number = 2", body));
  EXPECT_DOUBLE_EQ(by_speed.frequency, 0.4);
}

TEST(TwoLevelWave, SaysWhatDoesNotFit)
{
  expect_complaint("Largest strain = -0.3", "Largest strain", "one above the smallest, -0.3, is expected");
  expect_complaint("Share = 0.02", "Front width", "at most 0.02 is expected");
  expect_complaint("Frequency = 1e12", "Frequency", "periods");
  expect_complaint("Given by = wave speed; Wave speed = 1e12", "Wave speed", "periods");
  expect_complaint("Given by = work; Wave number = 1.5", "Given by", "a whole one is expected");
  expect_complaint("Given by = work; Ramp duration = 0.5", "Given by", "Ramp duration = 0 is expected");
  expect_complaint("Given by = work", "Given by", "no profile is expected", {{"Body/Elastic modulus profile", "1+s"}});
}
