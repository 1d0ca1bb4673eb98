// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Points and weights are those of deal.II, up to the last bit of a few.
#include "../../support/test.h"

#include <crawler/base/gauss_rule.h>

#include <deal.II/base/quadrature_lib.h>

namespace crawler
{
  void
  expect_same(const QuadratureRule &rule, const dealii::Quadrature<1> &expected)
  {
    ASSERT_EQ(rule.points.size(), expected.size());
    for (unsigned int i = 0; i < expected.size(); ++i)
    {
      EXPECT_DOUBLE_EQ(rule.points[i], expected.point(i)[0]);
      EXPECT_DOUBLE_EQ(rule.weights[i], expected.weight(i));
    }
  }

  TEST(GaussRule, IsThatOfDealII)
  {
    for (unsigned int n = 1; n <= 20; ++n)
      expect_same(gauss_rule(n), dealii::QGauss<1>(n));
    for (unsigned int n = 2; n <= 20; ++n)
      expect_same(gauss_lobatto_rule(n), dealii::QGaussLobatto<1>(n));
  }
} // namespace crawler
