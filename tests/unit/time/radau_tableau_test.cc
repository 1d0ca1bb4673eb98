// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The coefficients of the Radau IIA methods by what they are for: integrals and derivatives of powers at the nodes.
#include "../../support/test.h"

#include <crawler/time/radau_tableau.h>

#include <cmath>

using namespace crawler;

namespace
{
  constexpr double round_off = 1e-13; // relative to the entries, of size s^2

  double
  sum_of_powers(const double *weights, const std::vector<double> &c, const int power)
  {
    double sum = 0.;
    for (std::size_t j = 0; j < c.size(); ++j)
      sum += weights[j] * std::pow(c[j], power);
    return sum;
  }
} // namespace

class RadauTableauOf : public ::testing::TestWithParam<unsigned int>
{
protected:
  const RadauTableau &tableau = radau_tableau(GetParam());
  const int n                 = static_cast<int>(GetParam());
};

TEST_P(RadauTableauOf, IntegratesAndDifferentiatesPowers)
{
  for (int power = 0; power <= 2 * n - 2; ++power)
    EXPECT_NEAR(sum_of_powers(tableau.b.data(), tableau.c, power), 1. / (power + 1), round_off);
  for (int i = 0; i < n; ++i)
    for (int power = 1; power <= n; ++power)
      EXPECT_NEAR(sum_of_powers(tableau.inverse.data() + i * n, tableau.c, power),
                  power * std::pow(tableau.c[i], power - 1),
                  n * n * round_off);
}

TEST_P(RadauTableauOf, ErrorIsThatOfAWeightAtTheStart)
{
  for (int power = 1; power <= n; ++power)
    EXPECT_NEAR(sum_of_powers(tableau.error_weights.data(), tableau.c, power),
                power == 1 ? -1. / tableau.real_eigenvalue : 0.,
                round_off);
}

TEST_P(RadauTableauOf, EigenvectorsGiveTheMatrix)
{
  const std::size_t kept = 1 + tableau.n_pairs();
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
    {
      double one = 0., entry = 0.;
      for (std::size_t k = 0; k < kept; ++k)
      {
        const std::complex<double> part = (k == 0 ? 1. : 2.) * tableau.vectors[i * kept + k] * tableau.rows[k * n + j];
        one += part.real();
        entry += (part * (k == 0 ? tableau.real_eigenvalue : tableau.eigenvalues[k - 1])).real();
      }
      EXPECT_NEAR(one, i == j ? 1. : 0., round_off);
      EXPECT_NEAR(entry, tableau.inverse[i * n + j], n * n * round_off);
    }
}

INSTANTIATE_TEST_SUITE_P(Stages, RadauTableauOf, ::testing::Values(3, 5, 7));
