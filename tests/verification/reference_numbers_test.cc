// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The numbers of doc/theory.md section 5 to the digits printed there: displacements to 8 digits or more, works,
// energies and extreme stretches. Half a unit of the last digit is the tolerance.
#include "../support/run_text.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace crawler;

namespace
{
  SimulationResult
  accurate(test::Settings settings)
  {
    settings.emplace_back("Accuracy", "1e-9");
    return test::run_with(settings).result;
  }

  struct Row
  {
    double a, chi, speed, end_time, k, displacement, half_digit;
  };
} // namespace

TEST(ReferenceNumbers, Displacements)
{
  const std::vector<Row> rows = {{-1, 0.05, 1, 1, 1, 1.2505153917e-3, 0.6e-13},
                                 {-1, 0.1, 1, 1, 1, 5.020242991e-3, 1e-12},
                                 {-1, -0.1, 1, 1, 1, 5.043148e-3, 0.6e-9},
                                 {-1, 0.2, 1, 1, 1, 2.04422750e-2, 0.6e-10},
                                 {-1, 0.3, 1, 1, 1, 4.764510e-2, 0.6e-8},
                                 {-1, 0.4, 1, 1, 1, 9.0072529800e-2, 1e-10},
                                 {-1, -0.4, 1, 1, 1, 9.086315e-2, 0.6e-8},
                                 {-1, 0.5, 1, 1, 1, 0.155940, 0.6e-6},
                                 {-1, 0.4, 1, 20, 1, 1.801968240, 1.8e-9},
                                 {1, 0.4, -1, 1, 1, 8.1377661410e-2, 1e-10},
                                 {-3, 0.3, 1, 1, 1, 0.111869247645, 1e-10},
                                 {2, 0.3, 1, 1, 1, -8.1070868247e-2, 1e-10},
                                 {-1, 0.3, 1, 1, 10, 4.8552305987e-2, 1e-10},
                                 {-1, 0.3, 1, 1, 0.01, 4.6416054195e-2, 1e-10},
                                 {-1, 0.3, 1, 1, 100, 0.0486052726, 0.6e-10}};
  for (const Row &row : rows)
  {
    const auto result = accurate(test::wave(row.a, row.chi, row.speed, row.end_time, row.k));
    ASSERT_EQ(result.time.status, Status::finished);
    fmt::print("a = {:2g}, chi = {:5g}, c = {:2g}, T = {:2g}, k = {:4g}: {:.12g}, reference {:.12g}\n",
               row.a,
               row.chi,
               row.speed,
               row.end_time,
               row.k,
               result.displacement,
               row.displacement);
    EXPECT_NEAR(result.displacement, row.displacement, row.half_digit);
    EXPECT_LT(std::abs(result.displacement / row.displacement - 1.), row.half_digit > 1e-8 ? 1e-5 : 1e-6);
  }
}

TEST(ReferenceNumbers, FigS1)
{
  const auto weak = accurate(test::wave(-1., 0.1));
  EXPECT_NEAR(weak.min_stretch.value, 0.8004, 1e-4);
  EXPECT_NEAR(weak.max_stretch.value, 1.2003, 1e-4);
  EXPECT_NEAR(weak.energy_balance->stress_work, 4.991029e-3, 0.6e-9);

  const auto strong = accurate(test::wave(-1., 0.4));
  EXPECT_NEAR(strong.min_stretch.value, 0.2097, 1e-4);
  EXPECT_NEAR(strong.max_stretch.value, 1.79987, 1e-3); // sampled at the quadrature points
  EXPECT_NEAR(strong.energy_balance->stress_work, 0.083860120, 0.6e-9);
  EXPECT_NEAR(strong.energy_balance->dissipation, 0.083859451, 0.6e-9);
  EXPECT_NEAR(strong.energy_balance->paper_energy(), 0.08245, 0.6e-5);
  EXPECT_NEAR(strong.energy_balance->positive_work, 0.2853, 0.6e-4);

  EXPECT_NEAR(accurate(test::wave(-1., 0.5)).min_stretch.value, 0.0443, 1e-4);
}

TEST(ReferenceNumbers, Fig2)
{
  const auto result = accurate(test::wave(-1., 0.4, 1., 20.));
  EXPECT_NEAR(result.displacement, 1.801968240, 1.8e-9);
  EXPECT_NEAR(result.energy_balance->stress_work, 1.674733, 0.6e-6);
  // The first cycle gives 0.090073, each later one 0.090100.
  EXPECT_NEAR(accurate(test::wave(-1., 0.4, 1., 2.)).displacement, 0.090073 + 0.090100, 1e-6);
  EXPECT_NEAR(accurate(test::wave(-1., 0.4, 1., 3.)).displacement, 0.090073 + 2. * 0.090100, 1.5e-6);
}

/// The promise of Accuracy on the default settings of a scene that is not in the table: the default generator, 1e-6.
TEST(ReferenceNumbers, AccuracyDoesNotDependOnUnits)
{
  // The Fig. S1 case with L = 1e-3, k = 7, gamma = 11 and time in other units: chi/c a_n, k/(gamma c L) and cT/L as
  // before.
  const double L = 1e-3, gamma = 11., k = 7., c = k / (gamma * L);
  auto settings = test::wave(-1., 0.4, c, L / c, k);
  settings.insert(settings.end(),
                  {{"Body/Length", test::text(L)},
                   {"Body/Friction coefficient", test::text(gamma)},
                   {"Active stress/Optimal wave/Sine coefficients", test::text(c)}});
  const auto result = test::run_with(settings).result;
  EXPECT_NEAR(result.displacement / L / 9.0072529800e-2, 1., 1e-6);
}
