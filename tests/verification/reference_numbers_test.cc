// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The works, energies and extreme stretches of doc/theory.md section 5 to the digits printed there: half a unit of the
// last digit is the tolerance. Displacements are those of theory_table.cc and cycle_stop_test.cc.
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
} // namespace

/// A stiff body, which is not among the rows of theory_table.
TEST(ReferenceNumbers, StiffBody)
{
  EXPECT_NEAR(accurate(test::wave(-1., 0.3, 1., 1., 100.)).displacement, 0.0486052726, 0.6e-10);
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
