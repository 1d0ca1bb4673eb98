// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Switching profiles with fronts of a stated width, and windows and ramps made of them.
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/base/gauss_panels.h>
#include <crawler/scene/active_stress/envelope.h>
#include <crawler/scene/active_stress/profile.h>

using namespace crawler;

namespace
{
  double
  difference(const auto &f, const double x, const double h)
  {
    return (8. * (f(x + h) - f(x - h)) - (f(x + 2. * h) - f(x - 2. * h))) / (12. * h);
  }
} // namespace

TEST(SmoothStep, IsAStepWithItsRate)
{
  EXPECT_EQ(smooth_step(-1.), 0.);
  EXPECT_EQ(smooth_step(0.), 0.);
  EXPECT_EQ(smooth_step(1e-3), 0.);
  EXPECT_EQ(smooth_step(1.), 1.);
  EXPECT_EQ(smooth_step(7.), 1.);
  EXPECT_EQ(smooth_step(0.5), 0.5);
  EXPECT_NEAR(smooth_step(0.25), 1. / (1. + std::exp(8. / 3.)), 1e-15);
  EXPECT_NEAR(smooth_step_rate(0.5), 2., 1e-15);
  for (const double x : {0.03, 0.1, 0.3, 0.5, 0.77, 0.95})
  {
    EXPECT_NEAR(smooth_step(x) + smooth_step(1. - x), 1., 1e-15);
    EXPECT_NEAR(smooth_step_rate(x), difference(smooth_step, x, 1e-4), 1e-9) << x;
  }
  for (const double x : {-1., 0., 1e-200, 1e-3, 1. - 1e-16, 1., 2.})
    EXPECT_NEAR(smooth_step_rate(x), 0., 1e-100) << x;
}

TEST(Switching, JumpsWithoutFronts)
{
  const Switching half(0.5, 0.), short_one(0.2, 0.);
  EXPECT_TRUE(half.jumps());
  for (const double n : {-3., 0., 5.})
  {
    EXPECT_EQ(half.value(n + 0.25), 1.);
    EXPECT_EQ(half.value(n + 0.75), 0.);
    EXPECT_EQ(short_one.value(n + 0.1), 1.);
    EXPECT_EQ(short_one.value(n + 0.25), 0.);
  }
  EXPECT_EQ(half.rate(0.3), 0.);
  EXPECT_EQ(short_one.breaks(0., 2.), (std::vector<double>{0.2, 1., 1.2}));
  EXPECT_EQ(half.breaks(-0.25, 0.75), (std::vector<double>{0., 0.5}));
}

/// Steps of the width given about 0 and the duty, the mean of the sharp switch, and the exact rate.
TEST(Switching, HasFrontsOfTheWidthGiven)
{
  for (const auto &[duty, front] : {std::pair(0.5, 0.1), {0.3, 0.3}, {0.8, 0.2}, {0.5, 0.5}})
  {
    const Switching s(duty, front);
    EXPECT_FALSE(s.jumps());
    EXPECT_TRUE(s.breaks(0., 3.).empty());
    EXPECT_NEAR(s.value(0.), 0.5, 1e-15);
    EXPECT_NEAR(s.value(duty), 0.5, 1e-14);
    EXPECT_NEAR(s.value(0.5 * front), 1., 1e-14);
    EXPECT_NEAR(s.value(1. - 0.5 * front), 0., 1e-14);
    EXPECT_NEAR(s.value(duty - 0.5 * front), 1., 1e-14);
    EXPECT_NEAR(s.value(0.25 * front), smooth_step(0.75), 1e-14);
    EXPECT_NEAR(s.value(duty + 0.25 * front), smooth_step(0.25), 1e-14);
    const GaussPanels panels(0., 1., 200);
    std::vector<double> values;
    for (const double x : panels.points())
      values.push_back(s.value(x));
    EXPECT_NEAR(panels.integral(values), duty, 1e-12);
    for (double x = -0.97; x < 1.; x += 0.0637)
    {
      EXPECT_NEAR(s.value(x + 1.), s.value(x), 1e-13);
      EXPECT_NEAR(s.rate(x), difference([&](const double y) { return s.value(y); }, x, 1e-4 * front), 1e-6) << x;
    }
  }
}

TEST(Envelope, WindowAndRamp)
{
  EnvelopeParameters parameters;
  const Envelope all(parameters, "X/", 2.);
  for (const double s : {0., 1., 2.})
    EXPECT_EQ(all.window(s), 1.);
  EXPECT_EQ(all.ramp(0.), 1.);
  EXPECT_EQ(all.ramp_end(), 0.);
  EXPECT_TRUE(all.breaks_in_space().empty());

  parameters.window_start  = 0.4;
  parameters.window_end    = 1.6;
  parameters.ramp_duration = 5.;
  const Envelope sharp(parameters, "X/", 2.);
  EXPECT_EQ(sharp.window(0.39), 0.);
  EXPECT_EQ(sharp.window(0.41), 1.);
  EXPECT_EQ(sharp.window(1.59), 1.);
  EXPECT_EQ(sharp.window(1.61), 0.);
  EXPECT_EQ(sharp.breaks_in_space(), (std::vector<double>{0.4, 1.6}));
  EXPECT_EQ(sharp.ramp(2.), smooth_step(0.4));
  EXPECT_EQ(sharp.ramp_rate(2.), smooth_step_rate(0.4) / 5.);

  parameters.window_edge = 0.2;
  const Envelope smooth(parameters, "X/", 2.);
  EXPECT_TRUE(smooth.breaks_in_space().empty());
  EXPECT_NEAR(smooth.window(0.5), 0.5, 1e-14);
  EXPECT_NEAR(smooth.window(1.45), smooth_step(0.75), 1e-14);
  EXPECT_EQ(smooth.window(1.), 1.);
  EXPECT_EQ(smooth.window(0.3), 0.);

  // At the ends of the body: an edge only where it is asked for, and no break of the mesh.
  parameters             = {};
  parameters.window_end  = 2.;
  parameters.window_edge = 0.5;
  const Envelope fading(parameters, "X/", 2.);
  EXPECT_EQ(fading.window(0.), 1.);
  EXPECT_NEAR(fading.window(1.75), 0.5, 1e-14);
  EXPECT_EQ(fading.window(2.), 0.);
}
