// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/stress.h"
#include "../../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/scene/active_stress/modes.h>

using namespace crawler;

namespace
{
  using std::numbers::pi;
  constexpr double L = 2., T = 3.;

  ModesParameters
  modes(const std::string &in_time, const bool from_rest)
  {
    ModesParameters p;
    p.harmonics      = 2;
    p.in_time        = in_time;
    p.wave_speed     = 0.7;
    p.period         = 1.3;
    p.time_harmonics = 2;
    p.time_cells     = 4;
    p.from_rest      = from_rest;
    p.coefficients.clear();
    const std::size_t n_time = in_time == "travelling" ? 1 : in_time == "harmonics" ? 5 : from_rest ? 6 : 7;
    for (std::size_t i = 0; i < 5 * n_time; ++i)
      p.coefficients.push_back(std::sin(1. + 0.9 * static_cast<double>(i)));
    return p;
  }
} // namespace

TEST(Modes, TravelWithoutChangingTheirShape)
{
  ModesParameters p = modes("travelling", false);
  const auto c      = p.coefficients;
  const Modes stress(p, L, T);
  const double s = 0.3, t = 1.1, x = 2. * pi * (s + 0.7 * t) / L;
  const double exact =
    c[0] + c[1] * std::sin(x) + c[2] * std::cos(x) + c[3] * std::sin(2. * x) + c[4] * std::cos(2. * x);
  EXPECT_NEAR(test::values(stress, {s}, t)[0], exact, 1e-13);
  EXPECT_NEAR(*stress.period(), L / 0.7, 1e-15);
}

TEST(Modes, HarmonicsAreProductsOfModes)
{
  const ModesParameters p = modes("harmonics", false);
  const Modes stress(p, L, T);
  const double s = 0.3, t = 1.1, x = 2. * pi * s / L, y = 2. * pi * t / 1.3;
  const double space[5] = {1., std::sin(x), std::cos(x), std::sin(2. * x), std::cos(2. * x)},
               time[5]  = {1., std::sin(y), std::cos(y), std::sin(2. * y), std::cos(2. * y)};
  double exact          = 0.;
  for (std::size_t j = 0; j < 5; ++j)
    for (std::size_t k = 0; k < 5; ++k)
      exact += p.coefficients[5 * j + k] * time[j] * space[k];
  EXPECT_NEAR(test::values(stress, {s}, t)[0], exact, 1e-13);
}

/// Splines that are all 1 add up to 1.
TEST(Modes, SplinesAreAPartitionOfUnity)
{
  ModesParameters p = modes("splines", false);
  for (std::size_t i = 0; i < p.coefficients.size(); ++i)
    p.coefficients[i] = i % 5 == 0 ? 1. : 0.;
  const Modes stress(p, L, T);
  for (const double t : {0., 0.1, 0.75, 1.6, 2.9, 3.})
  {
    EXPECT_NEAR(test::values(stress, {0.4}, t)[0], 1., 1e-14);
    EXPECT_NEAR(test::rates(stress, {0.4}, t)[0], 0., 1e-13);
  }
  EXPECT_EQ(stress.breaks_in_time().size(), 3u);
}

TEST(Modes, KnowTheirRate)
{
  for (const std::string in_time : {"travelling", "harmonics", "splines"})
    for (const bool from_rest : {false, true})
    {
      const Modes stress(modes(in_time, from_rest), L, T);
      test::expect_rate(stress, L, {0.4, 1.3, 2.8}, 1e-7);
      for (const double m : test::values(stress, {0., 0.3, 1.7}, 0.))
        EXPECT_TRUE(!from_rest || std::abs(m) < 1e-15) << in_time;
    }
}

TEST(Modes, HaveNoMoreCoefficientsThanModes)
{
  ModesParameters p = modes("travelling", false);
  p.coefficients.push_back(1.);
  EXPECT_THROW(Modes(p, L, T), InputError);
}
