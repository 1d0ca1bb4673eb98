// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/stress.h"
#include "../../support/test.h"

#include <crawler/scene/active_stress_library.h>
#include <crawler/scene/scene.h>

using namespace crawler;

/// The formula of the theorem written out, for several harmonics and any L, gamma, k.
TEST(OptimalWave, IsTheFormulaOfThePaper)
{
  Body body;
  body.length               = 2.;
  body.elastic_modulus      = 3.;
  body.friction_coefficient = 0.7;
  OptimalWaveParameters parameters;
  parameters.perturbation_parameter = 0.3;
  parameters.sine_coefficients      = {1., -0.2, 0.4};
  parameters.cosine_coefficients    = {0.5, 0.1, -0.3};
  parameters.choose_wave_by         = "wave speed";
  parameters.wave_speed             = -1.3;
  const std::vector<double> points  = {0., 0.3, 1.1, 2.};
  const double c                    = parameters.wave_speed;
  const OptimalWave wave(parameters, body, 1.);
  for (const double t : {0., 0.2, 1.7, 250.})
  {
    const auto m = test::values(wave, points, t);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      double expected = 0.;
      const double s  = points[i];
      for (int n = 1; n <= 3; ++n)
      {
        const double a = parameters.sine_coefficients[n - 1], b = parameters.cosine_coefficients[n - 1];
        const double q = 2. * std::numbers::pi * n / body.length;
        expected +=
          body.friction_coefficient / q *
            (a * (std::cos(q * c * t) - std::cos(q * (s + c * t))) +
             b * (std::sin(q * (s + c * t)) - std::sin(q * c * t))) -
          body.elastic_modulus / c *
            (a * (std::sin(q * (s + c * t)) - std::sin(q * s)) + b * (std::cos(q * (s + c * t)) - std::cos(q * s)));
      }
      EXPECT_NEAR(m[i], 0.3 * expected, 1e-11) << "s = " << s << ", t = " << t;
    }
  }
}

TEST(NoActiveStress, IsZero)
{
  ActiveStressParameters parameters;
  parameters.generator = "none";
  for (const double m : test::values(*create_active_stress(parameters, Scene()), {0., 0.5, 1.}, 0.3))
    EXPECT_EQ(m, 0.);
}

TEST(Expression, EvaluatesWithConstants)
{
  ExpressionParameters parameters;
  parameters.active_stress = "A*sin(2*pi*(s/L + t/T)) + pow(s, B) + mod(-1, 3) + (s > 0.4 ? 1 : 2)";
  parameters.constants     = "A = 0.3, B=2";
  const Expression expression(parameters, 2., 5.);
  const std::vector<double> points = {0., 0.5, 2.};
  const auto m                     = test::values(expression, points, 1.25);
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_NEAR(m[i],
                0.3 * std::sin(2. * std::numbers::pi * (points[i] / 2. + 0.25)) + points[i] * points[i] + 2. +
                  (points[i] > 0.4 ? 1. : 2.),
                1e-14);
}
