// SPDX-License-Identifier: LGPL-2.1-or-later
//
// What the fused engine cannot do it hands over: a batch gives no answer, a simulation the one of PETSc.
#include "../../support/lane_runs.h"
#include "../../support/test.h"

using namespace crawler;
using test::expression;
using test::LaneRun;
using test::wave;

namespace
{
  const Numerics fine = {.degree = 6, .n_cells = 8, .tolerance = 1e-6, .initial_step = 1e-4};

  struct Case
  {
    std::string name;
    test::Settings settings;
    Numerics numerics = fine;
    Status status;
    std::string reason   = "";
    double error_of_time = 1e-4; ///< of an inversion, in parts of the duration
  };

  const Numerics short_steps = {
    .degree = 6, .n_cells = 8, .tolerance = 1e-6, .initial_step = 1e-4, .step_limits = {{0., 0.02}}};
  const Numerics one_jump = {.degree = 4, .n_cells = 2, .tolerance = 1e-4, .initial_step = 2e-2};

  std::vector<Case>
  cases()
  {
    return {
      {"SqueezedToNothing", wave(-1., 0.5), fine, Status::finished},
      {"InvertsAtAnEnd", expression(-1., "1.5*t"), fine, Status::inverted, "inverted_at_end"},
      {"InvertsAtTheRightEnd", expression(-1., "1.5*t*s^8"), fine, Status::inverted, "inverted_at_end"},
      {"AnEndInvertsForAMoment",
       expression(-1., "1.5*exp(-((t-0.5)/0.05)^2)*cos(pi*s)"),
       short_steps,
       Status::inverted,
       "inverted_at_end"},
      {"AnEndInvertsUnseenByTheMesh",
       expression(-0.1, "1.2*((t>0.2)-(t>0.25))", 0.3),
       one_jump,
       Status::inverted,
       "inverted_at_end"},
      {"IsInvertedFromTheStart", expression(-1., "1.2+0*t"), fine, Status::inverted, "inverted_at_end"},
      {"InvertsInsideWithConstantFriction",
       expression(0., "2*t*exp(-((s-0.5)/0.2)^2)"),
       fine,
       Status::inverted,
       "inverted_inside"},
      {"MeshIsTooCoarse",
       wave(-1., 0.8),
       {.degree = 2, .n_cells = 3, .tolerance = 1e-6, .initial_step = 1e-4},
       Status::failed,
       "under_resolved"},
      {"StepsTooMany",
       test::with(wave(-1., 0.3), {{"Time/Maximum number of steps", "7"}}),
       fine,
       Status::stopped,
       "step_limit"},
      // Newton's method fails in every second step, and the steps become no longer.
      {"NewtonsMethodGetsStuck",
       expression(12., "0.94*t", 3., 0.133),
       {.degree = 1, .n_cells = 7, .tolerance = 6e-10, .initial_step = 8e-3},
       Status::inverted,
       "inverted_at_end"},
    };
  }

  class FallbackTest : public ::testing::TestWithParam<Case>
  {
  };
} // namespace

TEST_P(FallbackTest, EndsAsWithPetsc)
{
  const Case &now = GetParam();
  for (const std::string integrator : {"radau 5", "radau 9"})
    for (const bool energy_balance : {true, false})
    {
      const LaneRun run(now.settings, integrator, now.numerics);
      const RecordOptions options = {.energy_balance = energy_balance};
      ASSERT_TRUE(lane_method(run.scene, run.parameters.time, run.numerics));
      EXPECT_FALSE(test::run_alone(run, options)) << integrator;
      const SimulationResult petsc = run.simulate(Engine::petsc, options),
                             fused = run.simulate(Engine::automatic, options);
      EXPECT_EQ(petsc.time.status, now.status) << integrator;
      EXPECT_EQ(petsc.time.reason, now.reason) << integrator;
      EXPECT_EQ(fused.time.status, now.status) << integrator << ": " << fused.time.message;
      EXPECT_EQ(fused.time.reason, now.reason) << integrator;
      ASSERT_EQ(fused.inversion.has_value(), petsc.inversion.has_value());
      if (petsc.inversion)
      {
        EXPECT_NEAR(fused.inversion->t, petsc.inversion->t, now.error_of_time * run.scene.end_time) << integrator;
        EXPECT_NEAR(fused.inversion->s, petsc.inversion->s, 1e-2) << integrator;
      }
      if (petsc.time.status == Status::finished)
      {
        EXPECT_NEAR(fused.displacement, petsc.displacement, run.numerics.tolerance) << integrator;
      }
    }
}

INSTANTIATE_TEST_SUITE_P(All, FallbackTest, ::testing::ValuesIn(cases()), [](const auto &test) {
  return test.param.name;
});

/// A stiff body follows its stress at once, w = 1 - m/k, and in the middle one of three stages this is 0.01; the end of
/// the only step is far from that. With an energy balance the stages are looked at.
TEST(Fallback, ABatchGivesUpWhatIsNearlyInvertedWithinItsLastStep)
{
  const LaneRun run(expression(-1., "990*sin(pi*t/1.29)", 1., 1000.),
                    "radau 5",
                    {.degree = 3, .n_cells = 3, .tolerance = 1e3, .initial_step = 1.});
  const auto at_ends = test::run_alone(run, {.energy_balance = false});
  ASSERT_TRUE(at_ends);
  EXPECT_EQ(at_ends->time.steps, 1u);
  EXPECT_GT(at_ends->stretch.min.value, 0.3);
  EXPECT_FALSE(test::run_alone(run, {.energy_balance = true}));
}

/// Extremes of parameters, alone and together: whatever comes out of a batch is what a simulation on PETSc says.
TEST(Fallback, ABatchSaysNothingThatASimulationDenies)
{
  test::LaneRuns runs;
  for (const std::string integrator : {"radau 5", "radau 9"})
    for (const double a : {-5., -0.5, 0.3, 4.})
      for (const double k : {1e-8, 1e-2, 1., 1e4})
        for (const std::string formula : {"A*t*sin(2*pi*(s+t))", "A*(t>0.31)*sin(pi*s)", "A*(s>0.5)", "A*t*cos(3*s)"})
          for (const double part : {0.1, 0.7})
            runs.push_back(std::make_unique<LaneRun>(
              test::with(expression(a, formula, 1., k),
                         {{"Active stress/Expression/Constants", "A=" + test::text(part * k)}}),
              integrator,
              Numerics{.degree = 4, .n_cells = 4, .tolerance = 1e-4, .initial_step = 1e-3}));
  const auto results    = run_batch(test::entries(runs), {.energy_balance = true});
  unsigned int finished = 0;
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    if (!results[i])
      continue;
    ++finished;
    const SimulationResult petsc = runs[i]->simulate(Engine::petsc);
    EXPECT_EQ(petsc.time.status, Status::finished) << i << ": " << petsc.time.message;
    EXPECT_NEAR(results[i]->displacement, petsc.displacement, 10. * runs[i]->numerics.tolerance) << i;
  }
  EXPECT_GT(finished, runs.size() / 3);
}
