// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/derivative.h"
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
    std::vector<double> g(stretches.size()), w_dg(stretches.size());
    law.values(stretches, g, w_dg);
    const auto expected = test::derivative([&](const double step) {
      std::vector<double> w = stretches, moved(w.size());
      for (double &stretch : w)
        stretch *= 1. + step;
      law.values(w, moved);
      return moved;
    });
    for (std::size_t i = 0; i < g.size(); ++i)
      EXPECT_NEAR(w_dg[i], expected[i], 1e-7 * (std::abs(g[i]) + std::abs(expected[i])))
        << "a = " << a << ", w = " << stretches[i];
  }
}
