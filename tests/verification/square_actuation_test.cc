// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Robots switch: square actuation by automatic numerics, with its error bounds.
#include "../support/answers.h"
#include "../support/lane_runs.h"
#include "../support/test.h"

#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/mesh_choices.h>
#include <crawler/accuracy/stress_scales.h>

using namespace crawler;
using test::computed;
using test::Settings;

namespace
{
  Settings
  segments(const unsigned int n, const std::string &gap, const double end_time)
  {
    return test::set("T = {}; segments; Number of segments = {}; Gap = {}; Phase lag = 0.125", end_time, n, gap);
  }

  Settings
  standing_wave(const double end_time)
  {
    return test::set("T = {}; standing wave; Amplitude = 0.3; Wave number = 0.5; Duty cycle = 0.3; Profile = square; "
                     "Window start = 0.2; Window end = 0.7",
                     end_time);
  }

  Settings
  travelling_wave(const std::string &profile, const double end_time)
  {
    return test::set("T = {}; travelling wave; Amplitude = 0.3; Wave number = 1.5; Profile = {}", end_time, profile);
  }

  bool
  jumps_move(const Settings &settings)
  {
    return stress_scales(test::parameters_with(settings).create_scene()).jumps_move;
  }

  SimulationResult
  with_numerics(const Settings &settings, const Numerics &numerics)
  {
    const Parameters parameters = test::parameters_with(settings);
    const Scene scene           = parameters.create_scene();
    SimulationResult result     = Simulation(MPI_COMM_SELF, scene, parameters.time, numerics).run({}, {});
    EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
    return result;
  }

  /// By levels and a tolerance that are far finer than what is chosen.
  double
  exact(const Settings &settings, const unsigned int n_cells)
  {
    Numerics n = {.degree = 8, .n_cells = n_cells, .tolerance = 1e-10, .integrator = "radau 9", .grading = {7, 0.4}};
    n.initial_step = first_step_on_graded_mesh(test::parameters_with(settings).create_scene(), n);
    return with_numerics(settings, n).displacement;
  }
} // namespace

/// What moves is told from what switches where it is, and from what is steep.
TEST(SquareActuation, MovingJumpsAreSeen)
{
  EXPECT_TRUE(jumps_move(travelling_wave("square", 1.)));
  EXPECT_TRUE(jumps_move(travelling_wave("square", 16.)));
  EXPECT_FALSE(jumps_move(travelling_wave("smoothed square", 1.)));
  EXPECT_FALSE(jumps_move(travelling_wave("sine", 1.)));
  EXPECT_FALSE(jumps_move(standing_wave(1.)));
  EXPECT_FALSE(jumps_move(segments(8, "0.3", 1.)));
  EXPECT_TRUE(jumps_move(test::set("expression; Active stress = s < t ? 0.3 : 0.1")));
  EXPECT_FALSE(jumps_move(test::set("expression; Active stress = (s < 0.37 ? 0.3 : 0.1)*cos(2*pi*t)")));
  EXPECT_FALSE(jumps_move(test::set("expression; Active stress = 0.3*tanh(1e4*(s - t))")));
}

namespace
{
  /// On a mesh of @p n_cells cells that the jumps pass through, with steps that follow them.
  double
  with_jumps_through_cells(const Settings &settings, const unsigned int n_cells)
  {
    return with_numerics(settings,
                         {.degree       = 2,
                          .n_cells      = n_cells,
                          .tolerance    = 1e-2 / n_cells,
                          .initial_step = 1e-5,
                          .step_limits  = {{0., 0.25 / n_cells}},
                          .integrator   = "radau 5"})
      .displacement;
  }
} // namespace

/// Every method is of first order where nobody says how the jumps move; the bound holds, and where Accuracy is out of
/// reach the run says so.
TEST(SquareActuation, UnknownMovingJumpsHaveAnHonestBound)
{
  const Settings settings = test::set("T = 0.5; expression; Active stress = mod(1.5*s+t,1) < 0.5 ? 0.3 : -0.3");
  const double limit      = 2. * with_jumps_through_cells(settings, 256) - with_jumps_through_cells(settings, 128);
  const auto good         = computed(test::with(settings, {{"Accuracy", "1e-2"}}));
  EXPECT_EQ(good.result.time.status, Status::finished) << good.result.time.message;
  EXPECT_LT(std::abs(good.result.displacement - limit), good.result.error->total);
  EXPECT_LT(good.result.error->total, 1e-2 * std::abs(limit));

  const auto hopeless = computed(test::with(settings, {{"Accuracy", "1e-6"}}));
  EXPECT_EQ(hopeless.result.time.reason, "accuracy_not_met");
  EXPECT_NE(hopeless.result.time.message.find("smoothed square"), std::string::npos) << hopeless.result.time.message;
  EXPECT_LT(std::abs(hopeless.result.displacement - limit), hopeless.result.error->total);
  EXPECT_LT(hopeless.result.error->total, 0.03 * std::abs(limit));
}

/// Waves with jumps are the limit of waves with fronts: the same scene as a formula, whose jumps pass through the
/// cells, agrees as far as that can tell, and answers at different accuracies are within their bounds.
TEST(SquareActuation, MovingJumpsAreTheLimitOfFronts)
{
  const Settings settings = travelling_wave("square", 0.5);
  const double fine       = with_jumps_through_cells(settings, 256),
               limit      = 2. * fine - with_jumps_through_cells(settings, 128);
  const auto accurate     = computed(test::with(settings, {{"Accuracy", "1e-5"}}));
  const double D          = accurate.result.displacement;
  ASSERT_EQ(accurate.result.time.status, Status::finished) << accurate.result.time.message;
  EXPECT_LT(accurate.result.error->total, 1e-5 * std::abs(D));
  EXPECT_LT(std::abs(D - limit), std::abs(limit - fine));
  // The widths are chosen by errors, whether these are wanted or not.
  EXPECT_EQ(computed(test::with(settings, {{"Accuracy", "1e-2"}, {"Error estimate", "false"}})).result.time.status,
            Status::finished);
  for (const char *const accuracy : {"1e-2", "1e-3", "1e-4"})
  {
    const auto usual = computed(test::with(settings, {{"Accuracy", accuracy}}));
    ASSERT_EQ(usual.result.time.status, Status::finished) << usual.result.time.message;
    EXPECT_LT(usual.result.error->total, std::stod(accuracy) * std::abs(D));
    EXPECT_LT(std::abs(usual.result.displacement - D), usual.result.error->total);
    EXPECT_LT(usual.result.energy_balance->residual(), 10. * std::stod(accuracy));
  }
}

/// More pieces between breaks than a coarse mesh has cells: each gets one, and more are tried.
TEST(SquareActuation, SegmentsGetGradedMeshes)
{
  for (const auto &[n, gap, pieces] : {std::tuple(8u, "0", 8u), std::tuple(8u, "0.3", 15u), std::tuple(30u, "0", 30u)})
  {
    const auto settings = test::with(segments(n, gap, 0.3), {{"Accuracy", "1e-5"}});
    const auto outcome  = computed(settings);
    ASSERT_EQ(outcome.result.time.status, Status::finished) << outcome.result.time.message;
    EXPECT_GE(outcome.choice.numerics.grading.levels, 1u);
    EXPECT_GE(outcome.choice.numerics.n_cells, pieces);
    const double error = std::abs(outcome.result.displacement - exact(settings, pieces));
    EXPECT_LT(error, outcome.result.error->total) << n << " " << gap;
    EXPECT_LT(error, 1e-5 * std::abs(outcome.result.displacement));
  }
}

/// Cells of 1e-6 of the length turn round-off into velocities: the energy balance takes those of the integrator.
TEST(SquareActuation, LedgerClosesOnTinyCells)
{
  const auto outcome = computed(test::with(standing_wave(1.5), {{"Accuracy", "1e-8"}}));
  EXPECT_EQ(outcome.result.time.status, Status::finished) << outcome.result.time.message;
  EXPECT_LT(outcome.result.energy_balance->residual(), 1e-7);
  EXPECT_LT(outcome.result.error->total, 1e-8 * std::abs(outcome.result.displacement));
}
