// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/test.h"

#include <crawler/reduced_models/kinematic.h>
#include <crawler/reduced_models/strain_functional.h>
#include <crawler/scene/known_stress.h>

using namespace crawler;

namespace
{
  using std::numbers::pi;

  Scene
  body(const double k, const double a)
  {
    return {.body          = {.elastic_modulus = k},
            .friction      = std::make_unique<PowerFriction>(1., a),
            .active_stress = nullptr,
            .end_time      = 1.};
  }

  /// A strain that is no wave, and from rest.
  StressByFunctions
  strain()
  {
    return StressByFunctions([](const std::vector<double> &s, const bool rate) {
      return stress_at_points([=](const double t, const std::span<double> e) {
        for (std::size_t i = 0; i < e.size(); ++i)
        {
          const double x = 2. * pi * s[i], y = 2. * pi * (s[i] + t), slow = 0.1 * std::cos(pi * s[i]);
          e[i] = rate ? 0.4 * pi * std::cos(y) + slow : 0.2 * (std::sin(y) - std::sin(x)) + slow * t;
        }
      });
    });
  }
} // namespace

/// theory.md, section 6: a = -1, e = 0.3 sin 2 pi (s + t) gives D = Q = 1 - sqrt(1 - 0.09).
TEST(StrainFunctional, OfASineWaveIsExact)
{
  const StressByFunctions wave([](const std::vector<double> &s, const bool rate) {
    return stress_at_points([=](const double t, const std::span<double> e) {
      for (std::size_t i = 0; i < e.size(); ++i)
      {
        const double x = 2. * pi * (s[i] + t);
        e[i]           = rate ? 0.6 * pi * std::cos(x) : 0.3 * std::sin(x);
      }
    });
  });
  const StrainFunctional grid(4, 2);
  const Scene scene = body(1., -1.);
  const auto values = grid.values(grid.sample(wave), {scene, grid.points});
  ASSERT_TRUE(values);
  const double exact = 1. - std::sqrt(1. - 0.09);
  EXPECT_NEAR((*values)[StrainFunctional::displacement], exact, 1e-10);
  EXPECT_NEAR((*values)[StrainFunctional::dissipation], exact, 1e-10);
  EXPECT_NEAR((*values)[StrainFunctional::stress_work], exact, 1e-10); // the strain repeats
  EXPECT_NEAR((*values)[StrainFunctional::mean_square], 0.045, 1e-10);
}

/// The weights are exact derivatives of the quadrature: against differences in some direction, for bodies that are the
/// same everywhere and for one whose friction and stiffness vary.
TEST(StrainFunctional, WeightsAreDerivatives)
{
  constexpr double step = 1e-5;
  const StrainFunctional grid(3, 3);
  const StrainSamples samples = grid.sample(strain());
  for (const double a : {-3., -1., 0.5, 2., 3.})
  {
    Scene scene = body(0.7, a);
    if (a == 3.)
      scene.profiles = read_profiles({.elastic_modulus_profile = "0.5+s", .friction_profile = "1.5-s"}, 1.);
    const BodyAtPoints at_points(scene, grid.points);
    for (const auto number : {StrainFunctional::displacement,
                              StrainFunctional::dissipation,
                              StrainFunctional::stress_work,
                              StrainFunctional::positive_work,
                              StrainFunctional::mean_square})
    {
      const StrainSamples weights = grid.weights(number, samples, at_points);
      double derivative           = 0.;
      StrainSamples before = samples, after = samples;
      for (std::size_t i = 0; i < samples.strain.size(); ++i)
      {
        const double x = std::sin(0.37 * static_cast<double>(i)), y = std::cos(0.53 * static_cast<double>(i));
        derivative += weights.strain[i] * x + weights.rate[i] * y;
        before.strain[i] -= step * x;
        before.rate[i] -= step * y;
        after.strain[i] += step * x;
        after.rate[i] += step * y;
      }
      const double difference =
        ((*grid.values(after, at_points))[number] - (*grid.values(before, at_points))[number]) / (2. * step);
      // The positive part of the power changes its sign somewhere.
      const double tolerance = number == StrainFunctional::positive_work ? 1e-4 : 1e-8;
      EXPECT_NEAR(derivative, difference, tolerance * std::max(std::abs(difference), 0.01))
        << "number " << number << ", a = " << a;
    }
  }
}

TEST(StrainFunctional, RefusesABodyThatInverts)
{
  const StrainFunctional grid(1, 1);
  StrainSamples samples = grid.sample(strain());
  samples.strain[5]     = -1.;
  const Scene scene     = body(1., -1.);
  EXPECT_FALSE(grid.values(samples, {scene, grid.points}));
}

TEST(GaussPanels, EndAtBreaks)
{
  EXPECT_EQ(GaussPanels::number_ending_at({0.1, 0.7}, 128), 10u);
  EXPECT_EQ(GaussPanels::number_ending_at({1. / std::numbers::pi}, 128), 1u);
  EXPECT_EQ(GaussPanels::ends_at({0.1, 0.7}, 1., 4), (std::vector<double>{0., 0.1, 0.3, 0.5, 0.7, 0.85, 1.}));
  EXPECT_EQ(GaussPanels::ends_at({0., 2., 3.}, 2., 2), (std::vector<double>{0., 1., 2.}));
}
