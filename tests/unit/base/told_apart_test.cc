// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/told_apart.h>

using namespace crawler;

TEST(ToldApart, HasAllDigitsOnlyBesideANumberThatLooksTheSame)
{
  EXPECT_EQ(told_apart(1.599997, {1.6}), "1.599997");
  EXPECT_EQ(told_apart(1.6, {1.599997}), "1.6");
  EXPECT_EQ(told_apart(1. / 3., {1.}), "0.333333");
  EXPECT_EQ(told_apart(1. / 3., {1. / 3.}), "0.333333");
}
