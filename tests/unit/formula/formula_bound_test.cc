// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/random.h"
#include "../../support/test.h"

#include <crawler/formula/formula_bound.h>
#include <crawler/formula/formula_gradient.h>

using namespace crawler;

namespace
{
  const char *const formulas[] = {
    "0.1*sin(2*pi*(s+t))",
    "cos(3*t-s)*tan(0.3*t)+asin(0.5*s)*acos(0.4*t)+atan(5*(t-s))",
    "sinh(t)*cosh(s-t)-tanh(9*(t-0.4))+asinh(t)*0.1",
    "exp(-((s-2*t)/0.1)^2)+exp(-((t-0.3)/0.01)^2)",
    "log(1+t)*log2(2+s)+log10(3+s*t)+ln(1.5+t)",
    "sqrt(0.1+t)*abs(t-0.5)+sqrt(abs(s-t))",
    "erf(7*(t-s))-erfc(3*t)+pow(0.2+s,2.5)*t^3+t^(-1)*0",
    "(1.2+t)^(s+t)+(t-0.4)^2*(s-0.5)^3+2^t",
    "min(t,s)+max(t^2,0.3*s,0.1)-sum(t,s,1)+avg(t,2*s)",
    "s<0.4 ? t : 2*t^2",
    "1/(1+t*s)-t/(2-t)+s/(0.5+t^2)",
    "-t+(s>t-3 && t<9 ? sin(t) : 7)+(s>2 || t<-1 ? 5*t : 0)",
    "mod(s,0.3)*t+floor(s*3)*t+sign(s-0.5)*t+rint(2*s)*t+ceil(s)*t",
    "cosh(t-0.5)*(t!=9)+(s<=t+2)*(s>=-t)*(s==5)*t",
  };

  struct Compiled
  {
    std::shared_ptr<const Formula> formula;
    FormulaBound bound;

    explicit Compiled(const std::string &text)
      : formula(std::make_shared<const Formula>(text, Formula::Constants{{"pi", std::numbers::pi}}))
      , bound(formula)
    {
    }
  };
} // namespace

/// Value and derivative are in the enclosure, at random points of random boxes of all sizes.
TEST(FormulaBound, Encloses)
{
  test::Random random(1);
  for (const char *text : formulas)
  {
    Compiled f(text);
    for (unsigned int i = 0; i < 400; ++i)
    {
      const double size = random.log_uniform(1e-6, 1.), s = random.uniform(0., 1. - size),
                   t     = random.uniform(0.01, 1. - size);
      const Enclosure in = f.bound({s, s + size}, {t, t + size});
      for (unsigned int j = 0; j < 8; ++j)
      {
        const double at = t + random.uniform(0., size);
        std::vector<double> value(1), rate(1);
        const std::vector<double> place = {s + random.uniform(0., size)};
        FormulaGradient(f.formula).evaluate(std::array<std::span<const double>, 2>{{place, {&at, 1}}},
                                            value,
                                            std::array<std::span<double>, 2>{{{}, rate}});
        const double rounding = 1e-12 * (1. + std::abs(value[0]));
        EXPECT_GE(value[0], in.value.lower() - rounding) << text;
        EXPECT_LE(value[0], in.value.upper() + rounding) << text;
        EXPECT_GE(rate[0], in.rate.lower() - 1e-9 * (1. + std::abs(rate[0]))) << text;
        EXPECT_LE(rate[0], in.rate.upper() + 1e-9 * (1. + std::abs(rate[0]))) << text;
      }
    }
  }
}

/// At a point nothing is too wide.
TEST(FormulaBound, IsExactAtPoints)
{
  for (const char *text : formulas)
  {
    Compiled f(text);
    const Enclosure at = f.bound({0.37, 0.37}, {0.71, 0.71});
    EXPECT_NEAR(at.value.lower(), at.value.upper(), 1e-12 * (1. + std::abs(at.value.upper()))) << text;
    EXPECT_NEAR(at.rate.lower(), at.rate.upper(), 1e-9 * (1. + std::abs(at.rate.upper()))) << text;
  }
}

/// A jump at a time is infinitely fast; one at a place is no change in time.
TEST(FormulaBound, KnowsJumps)
{
  for (const char *text : {"t<0.5 ? 1 : 2", "sign(t-0.5)", "floor(2*t)", "mod(t,0.5)", "(t>0.5)*3", "(t>0.2 && t<0.5)"})
  {
    Compiled f(text);
    EXPECT_TRUE(std::isinf(norm(f.bound({0., 1.}, {0.4, 0.6}).rate))) << text;
    EXPECT_TRUE(std::isfinite(norm(f.bound({0., 1.}, {0.51, 0.6}).rate))) << text;
  }
  EXPECT_EQ(norm(Compiled("s<0.5 ? 1 : 2").bound({0., 1.}, {0., 1.}).rate), 0.);
}
