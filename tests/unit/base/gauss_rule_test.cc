// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/base/gauss_rule.h>

namespace crawler
{
  /// Exact for polynomials up to a degree, which no other rule with as many points is. In Legendre's polynomials: all
  /// integrals but that of P_0 are 0.
  void
  expect_exact(const QuadratureRule &rule, const unsigned int degree)
  {
    EXPECT_TRUE(std::ranges::is_sorted(rule.points));
    for (unsigned int k = 0; k <= degree + 1; ++k)
    {
      double integral = 0.;
      for (std::size_t i = 0; i < rule.points.size(); ++i)
        integral += rule.weights[i] * std::legendre(k, 2. * rule.points[i] - 1.);
      if (k <= degree)
        EXPECT_NEAR(integral, k == 0 ? 1. : 0., 2e-15) << rule.points.size() << " points, P_" << k;
      else
        EXPECT_GT(std::abs(integral), 1e-3);
    }
  }

  TEST(GaussRule, IsExactForPolynomials)
  {
    for (unsigned int n = 1; n <= 20; ++n)
      expect_exact(gauss_rule(n), 2 * n - 1);
    for (unsigned int n = 2; n <= 20; ++n)
    {
      const QuadratureRule rule = gauss_lobatto_rule(n);
      expect_exact(rule, 2 * n - 3);
      EXPECT_EQ(rule.points.front(), 0.);
      EXPECT_EQ(rule.points.back(), 1.);
    }
  }
} // namespace crawler
