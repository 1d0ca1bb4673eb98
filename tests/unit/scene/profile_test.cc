// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The smooth step; switches, windows and ramps that are made of it are in waves_test.cc.
#include "../../support/derivative.h"
#include "../../support/test.h"

#include <crawler/scene/active_stress/wave_entries.h>

using namespace crawler;

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
    const auto moved = [x](const double step) { return std::vector<double>{smooth_step(x + step)}; };
    EXPECT_NEAR(smooth_step_rate(x), test::derivative(moved)[0], 1e-9) << x;
  }
  for (const double x : {-1., 0., 1e-200, 1e-3, 1. - 1e-16, 1., 2.})
    EXPECT_NEAR(smooth_step_rate(x), 0., 1e-100) << x;
}
