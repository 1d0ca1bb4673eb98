// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/step_limits.h>

using namespace crawler;

namespace
{
  /// Long steps but for a tenth in the middle.
  constexpr StepLimit limits[] = {{0., 0.3}, {0.5, 1e-3}, {0.6, HUGE_VAL}};

  double
  step(const double t, const double wanted)
  {
    unsigned int present = 0;
    return admitted_step(limits, 3, present, t, wanted);
  }
} // namespace

TEST(StepLimits, NoStepIsLongerThanALimitThatItMeets)
{
  EXPECT_EQ(step(0., 1.), 0.3);
  EXPECT_EQ(step(0., 0.1), 0.1);
  EXPECT_DOUBLE_EQ(step(0.4, 1.), 0.1) << "it ends where the small one begins";
  EXPECT_EQ(step(0.4995, 1.), 1e-3) << "but a small step may pass that";
  EXPECT_EQ(step(0.55, 1.), 1e-3);
  EXPECT_EQ(step(0.7, 5.), 5.);
  unsigned int present = 0;
  EXPECT_EQ(admitted_step(nullptr, 0, present, 0., 2.), 2.);
}
