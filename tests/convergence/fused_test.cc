// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Required orders of the fused engine in time: 5 and 9; those in space are in space_test.cc.
#include "../support/lane_runs.h"
#include "../support/observed_order.h"
#include "../support/test.h"

using namespace crawler;
using test::LaneRun;

/// With a tolerance that any step meets all steps have the largest length. Newton's method is exact for a = 0, where
/// the equation is linear. A stress that starts smoothly and a body that is not stiff: else the order is reduced.
TEST(Fused, ReachesItsOrderWithEqualSteps)
{
  const auto energy = [](const std::string &integrator, const unsigned int n) {
    const LaneRun run(
      test::expression(0., "0.02*sin(pi*t/2)^8*cos(3*(s-2*t))", 1., 0.05),
      integrator,
      {.degree = 4, .n_cells = 1, .tolerance = 1e3, .initial_step = 1. / n, .step_limits = {{0., 1. / n}}});
    const auto result = test::run_alone(run);
    EXPECT_EQ(result->time.steps, n) << integrator;
    return result->energy_balance->elastic_energy;
  };
  const double exact = energy("radau 9", 200);
  for (const auto &[integrator, order, steps] : {std::tuple("radau 5", 5., std::vector<double>{20, 40, 80}),
                                                 std::tuple("radau 9", 9., std::vector<double>{16, 24, 32})})
  {
    std::vector<double> errors;
    for (const double n : steps)
      errors.push_back(std::abs(energy(integrator, static_cast<unsigned int>(n)) / exact - 1.));
    const double observed = test::observed_order(integrator, steps, errors);
    EXPECT_GE(observed, order - 0.3) << integrator;
  }
}

/// The steps follow the embedded formula, whose error goes as h^(s+1) with s stages; so the error of the method goes
/// faster to 0 than the tolerance, and what is left of it at the end is that of Newton's method, a part of the
/// tolerance. That the equations are solved for the right method is compared with PETSc (unit/fused).
TEST(Fused, ErrorsFallWithTheToleranceOnTheWholeEquation)
{
  const auto run = [](const std::string &integrator, const double tolerance) {
    const LaneRun now(test::expression(-1., "0.4*sin(pi*t)^8*cos(2*pi*(s-t))"),
                      integrator,
                      {.degree = 4, .n_cells = 8, .tolerance = tolerance, .initial_step = 1e-2});
    return *test::run_alone(now);
  };
  const double exact = run("radau 9", 1e-14).displacement;
  for (const auto &[integrator, order, tolerances] :
       {std::tuple("radau 5", 4., std::vector<double>{1e-6, 1e-7, 1e-8, 1e-9}),
        std::tuple("radau 9", 6., std::vector<double>{1e-4, 1e-5, 1e-6, 1e-7, 1e-8})})
  {
    std::vector<double> steps, errors;
    for (const double tolerance : tolerances)
    {
      const auto result = run(integrator, tolerance);
      steps.push_back(result.time.steps);
      errors.push_back(std::abs(result.displacement - exact));
      EXPECT_LT(errors.back(), 0.1 * tolerance) << integrator;
    }
    const double observed = test::observed_order(integrator, steps, errors);
    EXPECT_GE(observed, order - 0.3) << integrator;
  }
}
