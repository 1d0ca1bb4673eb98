// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/scene/friction_law.h>

using namespace crawler;

namespace
{
  const std::vector<double> exponents = {-20, -3, -1.5, -1, 0, 0.5, 1, 2, 20};
  const std::vector<double> stretches = {0.2, 0.5, 0.99, 1., 1.3, 3.};
} // namespace

/// g(w) = gamma w^a, also where powers are computed as products.
TEST(PowerFriction, ValuesAreThePower)
{
  for (const double a : exponents)
  {
    const PowerFriction law(2.5, a);
    std::vector<double> g(stretches.size());
    law.values(stretches, g);
    for (std::size_t i = 0; i < g.size(); ++i)
      EXPECT_NEAR(g[i] / (2.5 * std::pow(stretches[i], a)), 1., 1e-13) << "a = " << a << ", w = " << stretches[i];
  }
}

TEST(PowerFriction, DerivativeMatchesDifferences)
{
  for (const double a : exponents)
  {
    const PowerFriction law(0.7, a);
    std::vector<double> g(stretches.size()), w_dg(stretches.size()), plus(stretches.size()), minus(stretches.size());
    law.values_and_log_derivatives(stretches, g, w_dg);
    const double epsilon       = 1e-5;
    std::vector<double> w_plus = stretches, w_minus = stretches;
    for (std::size_t i = 0; i < stretches.size(); ++i)
    {
      w_plus[i] *= 1. + epsilon;
      w_minus[i] *= 1. - epsilon;
    }
    law.values(w_plus, plus);
    law.values(w_minus, minus);
    for (std::size_t i = 0; i < g.size(); ++i)
    {
      const double difference = (plus[i] - minus[i]) / (2. * epsilon);
      EXPECT_NEAR(w_dg[i], difference, 1e-7 * (std::abs(g[i]) + std::abs(difference)))
        << "a = " << a << ", w = " << stretches[i];
    }
  }
}
