// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The kinematic level against closed forms and theory.md, sections 5 and 6.
#include "../../support/run_text.h"
#include "../../support/test.h"

using namespace crawler;
using test::on_level;

namespace
{
  test::Settings
  strain(const double a, const std::string &formula)
  {
    return test::set("p = {}; prescribed strain; Strain = {}", 1. - a, formula);
  }
} // namespace

TEST(Kinematic, StrainOfTheOptimalWave)
{
  EXPECT_NEAR(on_level(test::wave(-1., 0.2)).displacement, 2.064390e-2, 1e-8);
  EXPECT_NEAR(on_level(test::wave(-1., 0.4)).displacement, 9.372520e-2, 1e-8);
}

/// For a = -1 and e = 0.3 sin 2 pi (s+t): D = Q = 1 - sqrt(1 - 0.09).
TEST(Kinematic, SineWaveOfStrain)
{
  const double exact = 1. - std::sqrt(1. - 0.09);
  const auto result  = on_level(strain(-1., "0.3*sin(2*pi*(s+t))"));
  EXPECT_EQ(result.time.status, Status::finished);
  EXPECT_NEAR(result.displacement, exact, 1e-11);
  EXPECT_LE(std::abs(result.displacement - exact), result.error->total + 1e-15);
  EXPECT_EQ(result.error->model, 0.);
  EXPECT_NEAR(result.energy_balance->dissipation, exact, 1e-11);
  EXPECT_NEAR(result.energy_balance->stress_work, exact, 1e-11); // the elastic energy is what it was
  EXPECT_LE(result.energy_balance->residual(), 1e-11);
  EXPECT_LE(result.residuals.net_friction, 1e-12);
  EXPECT_NEAR(result.stretch.min.value, 0.7, 1e-8);
  EXPECT_NEAR(result.stretch.max.value, 1.3, 1e-8);
}

TEST(Kinematic, OptimisedGaits)
{
  const auto retrograde = on_level(strain(-1., "0.08814294 + 0.29676868*sin(2*pi*(s+t)) + 0.09132339*cos(4*pi*(s+t))"));
  EXPECT_NEAR(retrograde.displacement, 0.051149479, 2e-9);
  EXPECT_NEAR(retrograde.energy_balance->dissipation, 0.051149479, 2e-9);
  const auto prograde = on_level(strain(2., "-0.0930008 + 0.29263653*sin(2*pi*(s-t)) - 0.10029035*cos(4*pi*(s-t))"));
  EXPECT_NEAR(prograde.displacement, 0.10710692, 1e-8);
  EXPECT_NEAR(prograde.energy_balance->dissipation, 0.045139762, 1e-9);
}

/// Where nothing moves, the works say how fine the quadrature must be: they are continuous in a.
TEST(Kinematic, WorksWhereNothingMoves)
{
  const auto two_levels = [](const double a) {
    return on_level(test::set("p = {}; two-level wave", 1. - a), Model::kinematic, 1e-6);
  };
  const auto still = two_levels(0.), near = two_levels(1e-5);
  ASSERT_EQ(still.time.status, Status::finished);
  EXPECT_NEAR(still.displacement, 0., 1e-14);
  EXPECT_NEAR(still.energy_balance->dissipation / near.energy_balance->dissipation, 1., 1e-4);
  EXPECT_NEAR(still.energy_balance->stress_work / near.energy_balance->stress_work, 1., 1e-4);
}

/// A standing wave of strain, which has no travelling part: the body ends where it started.
TEST(Kinematic, ReciprocalMotionLeadsNowhere)
{
  const auto result = on_level(strain(-2., "0.4*sin(2*pi*s + 1)*sin(pi*t)^2"));
  EXPECT_NEAR(result.displacement, 0., 1e-12);
  EXPECT_GT(result.energy_balance->dissipation, 1e-3);
}

/// Strains of one shape: the displacement depends on the size at the end only, also if that has kinks in time.
TEST(Kinematic, KinksInTime)
{
  for (const auto &[kinked, smooth] : {std::pair("0.1*(t<0.31 ? t : 0.31)*s", "0.031*t*s"),
                                       {"0.2*sin(3*s)*abs(sin(7*t))", "0.2*sin(3*s)*abs(sin(7))*t"},
                                       {"0.1*max(0,sin(40*t))*s", "0.1*sin(40)*t*s"},
                                       {"0.02*abs(sin(300*t))*s", "0.02*abs(sin(300))*t*s"}})
  {
    const auto found = on_level(strain(-1., kinked));
    EXPECT_NEAR(found.displacement, on_level(strain(-1., smooth)).displacement, 1e-15) << kinked;
    EXPECT_LT(found.error->total, 1e-13) << kinked;
  }
}

/// The answer does not depend on the units: L = 2, gamma = 3, k = 5, T = 4.
TEST(Kinematic, Units)
{
  const double exact = 1. - std::sqrt(1. - 0.09);
  const auto result  = on_level(test::with(strain(-1., "0.3*sin(2*pi*(s/2+t/4))"), "L = 2; gamma = 3; k = 5; T = 4"));
  EXPECT_NEAR(result.displacement, 2. * exact, 1e-10);
  EXPECT_NEAR(result.energy_balance->dissipation, 3. * 2. * 2. * 2. / 4. * exact, 1e-10); // gamma L^3/T
  EXPECT_NEAR(result.stretch.min.value, 0.7, 1e-8);
  const double s = result.stretch.min.s, t = result.stretch.min.t;
  EXPECT_NEAR(std::sin(2. * std::acos(-1.) * (s / 2. + t / 4.)), -1., 1e-7);
}

/// For a = +1 the mean of g over the body is constant, and the level is the series exactly.
TEST(Kinematic, IsTheSeriesForAEqualToOne)
{
  for (const double c : {-1., 0.7, 1.6})
  {
    const auto settings = test::with(test::wave(1., 0.2, c, 0.9),
                                     "optimal wave; Sine coefficients = 1, 0.3; Cosine coefficients = 0.2, -0.1");
    const auto series = on_level(settings, Model::perturbation, 1e-1), motion = on_level(settings);
    EXPECT_NEAR(motion.displacement, series.displacement, 1e-12 + 1e-10 * std::abs(series.displacement));
  }
}

/// Of a stiff body: m = -k e makes the strain e, up to O(1/k).
TEST(Kinematic, StiffBody)
{
  const auto gap = [](const std::string &k) {
    const test::Settings settings =
      test::set("k = {0}; Accuracy = 1e-7; expression; Active stress = {0}*0.2*(sin(2*pi*(s+t)) - sin(2*pi*s))", k);
    return std::abs(on_level(settings).displacement - test::run_with(settings).result.displacement);
  };
  EXPECT_NEAR(gap("100") / gap("200"), 2., 0.2);
}

TEST(Kinematic, InvertedByTheStrainItAssumes)
{
  const auto result = on_level(test::wave(-1., 0.6));
  EXPECT_EQ(result.time.status, Status::inverted);
  ASSERT_TRUE(result.inversion);
  EXPECT_LE(result.inversion->value, 0.);
  EXPECT_FALSE(result.error);
}

/// A strain that is not smooth in s, whose kink is on the edge of no panel: the quadrature says how far it has come.
/// Strain that jumps in space: the displacement is a smooth function of the place, wherever that is.
TEST(Kinematic, JumpsInSpace)
{
  const auto at = [](const std::string &place) {
    return on_level(
      strain(-1., "0.3*(s > " + place + " ? 1 : 0)*sin(2*pi*t)*cos(2*pi*(s-t))"), Model::kinematic, 1e-10);
  };
  const SimulationResult here = at("1/pi");
  ASSERT_EQ(here.time.status, Status::finished) << here.time.message;
  EXPECT_LT(here.error->total, 1e-10);
  EXPECT_NEAR(here.displacement, 0.5 * (at("1/pi+1e-6").displacement + at("1/pi-1e-6").displacement), 1e-11);
}

TEST(Kinematic, AccuracyThatIsNotMetIsSaid)
{
  const auto result = on_level(strain(-1., "0.3*abs(sin(2*pi*(s-t)))*cos(2*pi*(2*s+t))"), Model::kinematic, 1e-10);
  EXPECT_EQ(result.time.status, Status::failed);
  EXPECT_EQ(result.time.reason, "accuracy_not_met");
  EXPECT_GT(result.error->space, 0.);
  const auto coarse = on_level(strain(-1., "0.3*abs(sin(2*pi*(s-t)))*cos(2*pi*(2*s+t))"), Model::kinematic, 1e-3);
  EXPECT_EQ(coarse.time.status, Status::finished);
  EXPECT_LE(std::abs(coarse.displacement - result.displacement), coarse.error->total + result.error->total);
}
