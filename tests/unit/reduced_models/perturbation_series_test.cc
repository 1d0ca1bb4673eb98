// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The series in natural units against wave_roots.h, which has the same formulas in the user's units, and against
// integrals of its own fields.
#include "../../support/run_text.h"
#include "../../support/test.h"
#include "../../support/wave_energy.h"

#include <crawler/reduced_models/perturbation.h>
#include <crawler/reduced_models/reduced_scene.h>

using namespace crawler;

namespace
{
  test::Settings
  settings()
  {
    return test::set("L = 2; k = 3; gamma = 0.5; p = 3.3; T = 1.7; chi = 0.1; c = 0.8; "
                     "Active stress/Optimal wave/Sine coefficients = 1, 0.3; "
                     "Active stress/Optimal wave/Cosine coefficients = 0.2, -0.4");
  }
} // namespace

TEST(PerturbationSeries, IsTheTheorem)
{
  const Scene scene = test::parameters_with(settings()).create_scene();
  const ReducedScene levels(scene);
  const auto &wave          = dynamic_cast<const OptimalWave &>(*scene.active_stress);
  const NaturalWave &series = *levels.wave;
  EXPECT_NEAR(perturbation::displacement(series, 1.) * scene.body.length, wave.wave().displacement, 1e-14);
  const double H = test::wave_energy(scene.body, wave.shape(), scene.end_time, 0.8), chi = 0.1;
  EXPECT_NEAR(perturbation::energies(series, 1.).stress_work * levels.units.energy(), chi * chi * H, 1e-14);
  const auto extremes = perturbation::extremes(series);
  EXPECT_NEAR(1. + extremes.smallest.strain, wave.wave().min_stretch, 1e-3); // which looks at 256 points
  EXPECT_LE(1. + extremes.smallest.strain, wave.wave().min_stretch);
  EXPECT_GE(1. + extremes.largest.strain, wave.wave().max_stretch);
}

/// Rates are the derivatives of what they belong to, the strain is that of the displacement, and the active stress is
/// that of the scene.
TEST(PerturbationSeries, FieldsFitTogether)
{
  const Scene scene = test::parameters_with(settings()).create_scene();
  const ReducedScene levels(scene);
  const NaturalWave &series = *levels.wave;
  const double t = 0.37, h = 1e-5;
  const std::vector<double> points = {0.2 - h, 0.2, 0.2 + h};
  const auto now = perturbation::fields(series, t, points), before = perturbation::fields(series, t - h, points),
             after = perturbation::fields(series, t + h, points);
  EXPECT_NEAR(now.strain[1], (now.displacement[2] - now.displacement[0]) / (2. * h), 1e-8);
  EXPECT_NEAR(now.velocity[1], (after.displacement[1] - before.displacement[1]) / (2. * h), 1e-8);
  EXPECT_NEAR(perturbation::velocity(series, t),
              (perturbation::displacement(series, t + h) - perturbation::displacement(series, t - h)) / (2. * h),
              1e-9);
  std::vector<double> m(3);
  levels.scene.active_stress->at(points)->values(t, m);
  for (unsigned int i = 0; i < 3; ++i)
    EXPECT_NEAR(now.active_stress[i], m[i], 1e-13);
  std::vector<double> e_t(3);
  levels.strain->rate_at(points)->values(t, e_t);
  EXPECT_NEAR(e_t[1], (after.strain[1] - before.strain[1]) / (2. * h), 1e-7);
}
