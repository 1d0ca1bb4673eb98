// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/expect_near.h"
#include "../../support/test.h"
#include "../../support/with_breaks.h"

#include <crawler/scene/active_stress/expression.h>
#include <crawler/scene/active_stress/strain_feedback.h>
#include <crawler/scene/profile.h>
#include <crawler/scene/scene.h>

using namespace crawler;

namespace
{
  /// m = t, with such breaks.
  std::unique_ptr<test::WithBreaks>
  with(const std::vector<double> &in_space, const std::vector<double> &in_time)
  {
    return std::make_unique<test::WithBreaks>(
      std::make_unique<Expression>(ExpressionParameters{.active_stress = "t"}, 1., 1.), in_space, in_time);
  }
} // namespace

TEST(Breaks, AreSortedDistinctAndInside)
{
  using List = std::vector<double>;
  EXPECT_EQ(distinct_breaks_in_space({1.5, 0.5, 0., 2., 0.5 + 1e-10, -3., 7.}, 2.), (List{0.5, 1.5}));
  EXPECT_EQ(TimeSegments(*with({}, {3., 1., 4., 0., 1. + 1e-13, 9.}), 4.).breaks(), (List{0.25, 0.75}));
  EXPECT_TRUE(TimeSegments(*with({}, {}), 4.).breaks().empty());
}

/// Echoes of jumps, and of the ends of the body, where a feedback sees them.
TEST(Breaks, HaveEchoes)
{
  const auto expect =
    [](const double jump, const StrainFeedbackParameters &parameters, const std::vector<double> &all) {
      Scene scene;
      scene.body.length   = 2.;
      scene.active_stress = std::make_unique<StrainFeedback>(parameters, 2., 1.);
      test::expect_near(scene.breaks_in_space(), all, 1e-14, test::text(jump));
    };
  expect(1.8, {.active_stress = "(s<1.8)+w_near", .distance = 0.8}, {0.2, 0.4, 1., 1.2, 1.8});
  expect(0.2, {.active_stress = "(s<0.2)+w_near", .distance = -0.8}, {0.2, 0.8, 1., 1.6, 1.8});
  const StrainFeedbackParameters sensor = {.active_stress = "(s<1.6)+w_near", .distance = 0.2, .sensor_length = 0.8};
  expect(1.6, sensor, {0.2, 0.4, 0.8, 1., 1.4, 1.6});
  // Short distances and sensors do not make tiny cells; a short sensor is a point.
  expect(1.8, {.active_stress = "(s<1.8)+w_near", .distance = 1e-3}, {1.8});
  expect(1.2, {.active_stress = "(s<1.2)+w_near", .distance = 0.8, .sensor_length = 1e-5}, {0.4, 1.2});
  const StrainFeedback delayed({.active_stress = "(t<0.3)+w_delayed", .delay = 0.4}, 2., 1.);
  test::expect_near(TimeSegments(delayed, 1.).breaks(), {0.3, 0.4, 0.7, 0.8}, 1e-14);
}

/// Within a piece no time of another is used, and none at its ends; without breaks times are what they are.
TEST(Breaks, PiecesAreEvaluatedInside)
{
  Scene scene;
  scene.friction      = std::make_unique<PowerFriction>(1., 0.);
  scene.end_time      = 2.;
  scene.active_stress = with({}, {0.5, 1.});
  TimeSegments pieces(*scene.active_stress, 2.);
  const Units units{1., 2., 1.};
  const Scene scaled = in_units(scene, units, &pieces);
  const auto stress  = scaled.active_stress->at({0.5});
  double m           = 0.;
  const auto at      = [&](const double t) {
    stress->values(t, {&m, 1});
    return m;
  };
  EXPECT_EQ(pieces.end(), 0.25);
  EXPECT_GT(at(0.), 0.);
  EXPECT_NEAR(at(0.), 0., 1e-11);
  EXPECT_EQ(at(0.1), 0.2);
  EXPECT_LT(at(0.25), 0.5);
  EXPECT_NEAR(at(0.25), 0.5, 1e-11);
  EXPECT_EQ(at(0.3), at(0.25));
  pieces.go_on();
  EXPECT_EQ(pieces.end(), 0.5);
  EXPECT_GT(at(0.25), 0.5);
  EXPECT_NEAR(at(0.25), 0.5, 1e-11);
  EXPECT_FALSE(pieces.is_last());
  pieces.go_on();
  EXPECT_TRUE(pieces.is_last());
  EXPECT_LT(at(1.), 2.);
  pieces.restart();
  EXPECT_EQ(at(0.1), 0.2);

  const Scene plain = in_units(scene, units);
  plain.active_stress->at({0.5})->values(0.25, {&m, 1});
  EXPECT_EQ(m, 0.5);
}

/// Jumps and kinks of a formula, whatever its units; a front that a mesh can follow is neither.
TEST(Breaks, OfFormulasOfTheBody)
{
  const auto expect = [](const std::string &formula, const std::vector<double> &places) {
    const auto profile = read_profile({{"friction", formula, "", "Body/Friction profile", "", {"s"}}}, 2., 1.);
    test::expect_near(distinct_breaks_in_space(profile->breaks(), 2.), places, 1e-12, formula);
  };
  expect("s<0.571*L ? 1 : 0.325", {1.142});
  expect("1+(s>0.3)*(s<0.7)+0.1*sin(40*s)", {0.3, 0.7});
  expect("1+abs(s-0.77)", {0.77});
  expect("1+0.01*(s>1)", {1.});
  expect("max(1,2*s)", {0.5});
  expect("2+tanh((s-1)/0.01)", {});
  expect("1+0.9*sin(50*s)", {});
  expect("exp(-8*s)", {});
}
