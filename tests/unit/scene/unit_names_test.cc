// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/scene/unit_names.h>

using namespace crawler;

TEST(UnitNames, TakeThePlaceOfTheWords)
{
  const UnitNames own = {"mm", "s", "mN"};
  EXPECT_EQ(own.of("force time/length^2"), "mN s/mm^2");
  EXPECT_EQ(own.of("energy"), "mN mm");
  EXPECT_EQ(own.of("times"), "times");
  EXPECT_EQ(own.behind("1"), "");
}
