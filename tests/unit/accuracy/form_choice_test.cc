// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/accuracy/form_choice.h>

using namespace crawler;

TEST(FormChoice, SoftAndEmptiedBodiesAreForTheStretchForm)
{
  EXPECT_TRUE(is_soft(/*stiffness=*/1e-4, /*exponent=*/-1., /*accuracy=*/1e-4));
  EXPECT_FALSE(is_soft(1., -1., 1e-4));
  EXPECT_TRUE(empties(/*smallest_stretch=*/0.01, -1., 1e-4));
  EXPECT_FALSE(empties(0.2, -1., 1e-4));
}

TEST(FormChoice, SteepFrictionMakesThinnerLayers)
{
  EXPECT_FALSE(is_soft(1e-2, -1., 1e-4));
  EXPECT_TRUE(is_soft(1e-2, -7., 1e-4));
}

/// The stretch form is of second order, so digits are dearer there.
TEST(FormChoice, LimitsFallWithAccuracy)
{
  EXPECT_FALSE(is_soft(1e-4, -1., 1e-9));
  EXPECT_FALSE(empties(0.02, -1., 1e-8));
  EXPECT_FALSE(is_cheaper_than_many_cells(/*lengths=*/6., 1e-9));
  EXPECT_TRUE(is_cheaper_than_many_cells(6., 1e-4));
  EXPECT_FALSE(is_cheaper_than_many_cells(100., 1e-4));
}

/// Friction that vanishes with the stretch holds nothing: what is lost there is lost.
TEST(FormChoice, NothingIsEmptiedWhereFrictionVanishes)
{
  EXPECT_FALSE(empties(1e-3, 0.5, 1e-4));
}
