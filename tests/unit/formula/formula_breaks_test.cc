// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/expect_near.h"
#include "../../support/test.h"

#include <crawler/formula/formula_breaks.h>

using namespace crawler;

namespace
{
  FormulaBreaks
  breaks_of(const std::string &text, const double length = 1., const double end_time = 2.)
  {
    const Formula::Constants constants = {{"pi", std::numbers::pi}};
    return formula_breaks(std::make_shared<const Formula>(text, constants), length, end_time);
  }

  void
  expect_breaks(const std::string &text, const std::vector<double> &in_space, const std::vector<double> &in_time)
  {
    const FormulaBreaks found = breaks_of(text);
    ASSERT_TRUE(found.in_space && found.in_time) << text;
    test::expect_near(*found.in_space, in_space, 2e-15, text);
    test::expect_near(*found.in_time, in_time, 2e-15, text);
  }
} // namespace

TEST(FormulaBreaks, AreWhereOperationsChangeSides)
{
  expect_breaks("sin(2*pi*(s+t))*exp(-t)+s^2", {}, {});
  expect_breaks("s<0.3 ? t : s*t", {0.3}, {});
  expect_breaks("(s>=0.25 && s<0.5)*sin(t)+(t<=0.7)", {0.25, 0.5}, {0.7});
  expect_breaks("abs(s-0.4)*abs(t-1.5)", {0.4}, {1.5});
  expect_breaks("min(2*s,1)*max(0,1-t,t-1.5)", {0.5}, {1., 1.5});
  expect_breaks("floor(3*s)+rint(t)", {1. / 3., 2. / 3., 1.}, {0.5, 1.5});
  expect_breaks("mod(s,0.4)*(mod(t,1)<0.25)", {0.4, 0.8}, {0.25, 1., 1.25, 2.});
  expect_breaks("sign(cos(pi*s))*sign(sin(pi*t-1))", {0.5}, {1. / std::numbers::pi, 1. + 1. / std::numbers::pi});
}

/// Segments that switch one after the other; places that depend on the time in steps.
TEST(FormulaBreaks, AreThoseOfStepsOfTheOtherVariable)
{
  expect_breaks("mod(t-floor(2*s)/4,1)<0.5", {0.5, 1.}, {0.25, 0.5, 0.75, 1., 1.25, 1.5, 1.75, 2.});
  expect_breaks("s<0.3*(1+floor(t))", {0.3, 0.6}, {1., 2.});
}

/// Breaks at the ends count, too: values there may be those of either side.
TEST(FormulaBreaks, AreFoundAtTheEnds)
{
  expect_breaks("(t>0)*(s<1)", {1.}, {0.});
  expect_breaks("(t<2)*(s>0)", {0.}, {2.});
}

TEST(FormulaBreaks, ThatMoveAreNone)
{
  expect_breaks("(s<0.5*t)*abs(s-t)*sign(sin(2*pi*(s+t)))", {}, {});
}

TEST(FormulaBreaks, AreFoundHoweverCloseTheyAre)
{
  constexpr double width = 1e-10;
  const auto found       = breaks_of("t>1.2345 && t<1.2345+1e-10 ? 1 : 0", 1., 2000.).in_time;
  ASSERT_TRUE(found && found->size() == 2);
  EXPECT_NEAR((*found)[1] - (*found)[0], width, 4e-16 * 2000.);
}

TEST(FormulaBreaks, AreAllThoseOfManyPeriods)
{
  const auto found = breaks_of("sin(2*pi*t)<0.3", 1., 1000.).in_time;
  ASSERT_TRUE(found);
  ASSERT_EQ(found->size(), 2000u);
  for (std::size_t i = 0; i < found->size(); ++i)
    EXPECT_NEAR(std::sin(2. * std::numbers::pi * (*found)[i]), 0.3, 1e-11);
}

/// What round-off decides is not searched for ever.
TEST(FormulaBreaks, AreGivenUp)
{
  EXPECT_FALSE(breaks_of("sign(sin(s)-sin(s)+t)+sign(sin(s)-sin(s))").in_space);
  EXPECT_FALSE(breaks_of("sin(2*pi*t)<0.3", 1., 1e5).in_time);
}
