// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Agreement with the leading-order theory (doc/theory.md, "What the theorem does not say"): m is given to O(chi) only,
// the displacement is 0.5 chi^2 - 0.0116 chi^3 + 0.314 chi^4 for Fig. S1, so even and odd parts in chi are compared.
#include "../support/run_text.h"

#include <crawler/scene/active_stress/wave_roots.h>

#include <gtest/gtest.h>

#include <cmath>

using namespace crawler;

namespace
{
  double
  displacement(const double a, const double chi, const double speed)
  {
    auto settings = test::wave(a, chi, speed);
    settings.emplace_back("Accuracy", "1e-9");
    const auto result = test::run_with(settings, {}).result;
    EXPECT_EQ(result.time.status, Status::finished);
    return result.displacement;
  }
} // namespace

TEST(Perturbation, EvenAndOddPartsOfFigS1)
{
  // even(chi) = d2 chi^2 + d4 chi^4 + ..., odd(chi) = d3 chi^3 + d5 chi^5 + ...; two values of chi eliminate the next
  // term.
  const auto even = [](const double chi) { return 0.5 * (displacement(-1., chi, 1.) + displacement(-1., -chi, 1.)); };
  const auto odd  = [](const double chi) { return 0.5 * (displacement(-1., chi, 1.) - displacement(-1., -chi, 1.)); };
  const double x = 0.05, y = 0.1;
  const double e_x = even(x) / (x * x), e_y = even(y) / (y * y), o_x = odd(x) / (x * x * x), o_y = odd(y) / (y * y * y);
  const double d4 = (e_y - e_x) / (y * y - x * x), d2 = e_x - d4 * x * x;
  const double d5 = (o_y - o_x) / (y * y - x * x), d3 = o_x - d5 * x * x;
  EXPECT_NEAR(d2, 0.5, 2e-5);
  EXPECT_NEAR(d4, 0.314, 0.01);
  EXPECT_NEAR(d3, -0.0116, 3e-4);
}

/// For other exponents and waves, the even part over chi^2 tends to the series' displacement.
TEST(Perturbation, LeadingOrderForOtherExponents)
{
  for (const auto &[a, speed] : {std::pair<double, double>{-3., 1.}, {1., -1.}, {2., 1.}, {-1., 0.8}, {-0.5, 1.3}})
  {
    Body body;
    body.anchoring_exponent = 1. - a;
    const double chi = 0.01, series = describe_wave(body, {{1.}, {0.}}, chi, 1., speed).displacement;
    const double even = 0.5 * (displacement(a, chi, speed) + displacement(a, -chi, speed));
    EXPECT_NEAR(even / series, 1., 2e-3) << "a = " << a << ", c = " << speed;
  }
}
