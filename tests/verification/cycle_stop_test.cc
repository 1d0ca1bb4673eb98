// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Runs that end when their cycles repeat, against runs to the end time.
#include "../support/answers.h"
#include "../support/test.h"

#include <crawler/base/exceptions.h>
#include <crawler/run/result_table.h>
#include <crawler/studies/core/compute.h>

using namespace crawler;

namespace
{
  struct Pair
  {
    SimulationResult cycles, full;
  };

  /// The same numerics with and without the stop; @p accuracy is that of the stop.
  Pair
  run_both(const test::Settings &settings, const double accuracy, const Engine engine = Engine::automatic)
  {
    auto parameters        = test::parameters_with(settings);
    parameters.time.engine = engine;
    const Scene scene      = parameters.create_scene();
    const auto choice      = *choose_numerics({parameters, scene, {}, MPI_COMM_WORLD});
    parameters.accuracy    = accuracy;
    Simulation simulation(MPI_COMM_WORLD, scene, parameters.time, choice.numerics);
    Pair pair;
    pair.cycles =
      simulation.run({}, {.energy_balance = true, .cycles = cycle_wish(parameters, scene, /*has_pictures=*/false)});
    pair.full = simulation.run({}, {.energy_balance = true});
    EXPECT_EQ(pair.full.time.status, Status::finished);
    EXPECT_EQ(pair.cycles.time.status, Status::finished);
    EXPECT_FALSE(pair.full.cycles);
    return pair;
  }

  /// What is computed where no files are written.
  SimulationResult
  compute(const Parameters &parameters)
  {
    const Scene scene = parameters.create_scene();
    return test::run_with(parameters,
                          {.energy_balance = true, .cycles = cycle_wish(parameters, scene, /*has_pictures=*/false)})
      .result;
  }

  /// The settings with Accuracy 1e-9.
  test::Settings
  accurate(const test::Settings &settings)
  {
    return test::with(settings, "Accuracy = 1e-9");
  }

  /// Is the difference within the bound, but for the errors in time of both runs?
  void
  expect_honest(const Pair &pair, const double accuracy)
  {
    ASSERT_TRUE(pair.cycles.cycles);
    const double error = std::abs(pair.cycles.displacement - pair.full.displacement);
    EXPECT_LE(error, pair.cycles.cycles->bound + 2e-9 * std::abs(pair.full.displacement));
    EXPECT_LE(pair.cycles.cycles->bound, 0.2 * accuracy * std::abs(pair.cycles.displacement));
    const EnergyBalance &cycles = *pair.cycles.energy_balance, &full = *pair.full.energy_balance;
    const double bound = (pair.cycles.cycles->work_bound + 2e-9) * full.exchanged_work;
    for (double EnergyBalance::*work :
         {&EnergyBalance::stress_work, &EnergyBalance::dissipation, &EnergyBalance::end_work})
      EXPECT_LE(std::abs(cycles.*work - full.*work), bound);
    EXPECT_LE(std::abs(cycles.paper_energy() - full.paper_energy()), bound);
  }
} // namespace

TEST(CycleStop, Fig2NeedsThreeOfItsTwentyCycles)
{
  for (const double accuracy : {1e-3, 1e-6, 1e-9})
  {
    const auto result =
      compute(test::parameters_with(test::with(test::wave(-1., 0.4, 1., 20.), "Accuracy = {}", accuracy)));
    ASSERT_TRUE(result.cycles);
    EXPECT_EQ(result.cycles->period, 1.);
    EXPECT_LE(result.cycles->computed, 3u);
    EXPECT_EQ(result.cycles->computed + result.cycles->extrapolated, 20u);
    EXPECT_EQ(result.time.time, 20.);
    EXPECT_NEAR(result.displacement, 1.801968240, accuracy * 1.8 + 0.6e-9);
    EXPECT_NEAR(
      result.energy_balance->stress_work, 1.674733, 5. * accuracy * 1.7 + 0.6e-6); // Accuracy is of the displacement
  }
}

TEST(CycleStop, LedgerIsThatOfTheWholeRun)
{
  const Pair pair = run_both(accurate(test::wave(-1., 0.4, 1., 20.)), 1e-9);
  expect_honest(pair, 1e-9);
  const EnergyBalance &cycles = *pair.cycles.energy_balance, &full = *pair.full.energy_balance;
  EXPECT_NEAR(cycles.stress_work / full.stress_work, 1., 1e-8);
  EXPECT_NEAR(cycles.dissipation / full.dissipation, 1., 1e-8);
  EXPECT_NEAR(cycles.positive_work / full.positive_work, 1., 1e-4); // its integrand has kinks
  EXPECT_NEAR(cycles.paper_energy() / full.paper_energy(), 1., 1e-8);
  EXPECT_NEAR(cycles.elastic_energy, full.elastic_energy, 1e-9 * full.exchanged_work);
  EXPECT_LT(cycles.residual(), 1e-9);
  EXPECT_NEAR(pair.cycles.stretch.min.value, pair.full.stretch.min.value, 1e-4);
  EXPECT_NEAR(pair.cycles.stretch.max.value, pair.full.stretch.max.value, 1e-3);
}

/// The bound of the displacement, which was taken for both, does not hold for them.
TEST(CycleStop, WorksMaySettleLaterThanTheDisplacement)
{
  const Pair pair = run_both(
    test::set("Accuracy = 1e-8; gamma = 10; p = -0.242; Ground/Backward ratio = 3; Ground/Switching velocity = "
              "0.05; T = 84; travelling wave; Amplitude = 0.433"),
    1e-5);
  expect_honest(pair, 1e-5);
  const double displacement   = std::abs(pair.full.displacement);
  const EnergyBalance &cycles = *pair.cycles.energy_balance, &full = *pair.full.energy_balance;
  EXPECT_GT(std::abs(cycles.dissipation - full.dissipation) / full.exchanged_work,
            pair.cycles.cycles->bound / displacement);
}

/// Searches compare runs of two cycles, as the start is forgotten in one, and go on from there.
TEST(CycleStop, EndsAfterTwoCyclesIfAsked)
{
  const auto parameters = test::parameters_with(test::wave(-1., 0.4, 1., 20.));
  auto wish             = cycle_wish(parameters, parameters.create_scene(), /*has_pictures=*/false);
  ASSERT_TRUE(wish);
  wish->accuracy    = 1e-9; // needs three
  wish->computed    = 2;
  const auto result = test::run_with(parameters, {.cycles = wish}).result;
  EXPECT_EQ(result.cycles->computed, 2u);
  EXPECT_EQ(result.cycles->extrapolated, 18u);
  EXPECT_NEAR(result.displacement, 1.801968240, 1e-4);
}

/// Where a ramp or a window delays the start, cycles begin behind it. A stress that jumps ends them at its breaks.
TEST(CycleStop, BehindAStart)
{
  for (const std::string stress :
       {"travelling wave; Amplitude = 0.3; Ramp duration = 2.3",
        "segments; Number of segments = 4; Amplitude = 0.3; Frequency = 1; Rate limit = 1.5; Ramp duration = 0.5",
        "segments; Number of segments = 2; Amplitude = 0.3",
        "sum; Term 1/Generator = travelling wave; Term 1/Travelling wave/Amplitude = 0.25; "
        "Term 1/Travelling wave/Ramp duration = 0.25; "
        "Term 2/Combine = multiply; Term 2/Generator = expression; Term 2/Expression/Active stress = 0.5 + s/L; "
        "Term 3/Generator = expression; Term 3/Window in t = 1.5, 2.5; Term 3/Edge width in t = 0.25; "
        "Term 3/Expression/Active stress = 0.2"})
  {
    const Pair pair = run_both(accurate(test::set("p = 2; T = 16; " + stress)), 1e-6);
    expect_honest(pair, 1e-6);
    ASSERT_TRUE(pair.cycles.cycles) << stress;
    EXPECT_EQ(pair.cycles.cycles->period, 1.);
    EXPECT_GT(pair.cycles.cycles->extrapolated, 8u) << stress;
  }
}

TEST(CycleStop, BdfAndAdaptiveMeshes)
{
  for (const char *own : {"Time/Integrator = bdf", "Discretization/Mesh = adaptive", "Time/Engine = petsc"})
  {
    const Pair pair = run_both(test::with(test::wave(-1., 0.3, 1., 6.), "Accuracy = 1e-5; {}", own), 1e-4);
    ASSERT_TRUE(pair.cycles.cycles) << own;
    EXPECT_NEAR(pair.cycles.displacement,
                pair.full.displacement,
                pair.cycles.cycles->bound + 2e-5 * std::abs(pair.full.displacement))
      << own;
    EXPECT_LT(pair.cycles.time.steps, pair.full.time.steps) << own;
  }
}

/// A soft body takes many cycles to settle: as many are computed as the accuracy needs, and the bound holds.
TEST(CycleStop, SlowSettling)
{
  unsigned int before = 2;
  for (const double accuracy : {1e-2, 1e-4, 1e-6})
  {
    const Pair pair = run_both(accurate(test::wave(1., 0.3, -1., 40., 0.05)), accuracy);
    expect_honest(pair, accuracy);
    EXPECT_GT(pair.cycles.cycles->computed, before);
    before = pair.cycles.cycles->computed;
  }
}

/// One that has not settled at the end is computed to the end.
TEST(CycleStop, NotSettled)
{
  const Pair pair = run_both(accurate(test::wave(-1., 0.2, 1., 8., 0.01)), 1e-7);
  EXPECT_FALSE(pair.cycles.cycles);
  EXPECT_NEAR(pair.cycles.displacement, pair.full.displacement, 2e-9 * std::abs(pair.full.displacement));
}

TEST(CycleStop, BodyThatInvertsLaterInverts)
{
  // The mean of the stress grows from cycle to cycle; without this part the period would be 1.
  test::Settings settings = test::set("p = 0; T = 20; expression; Active stress = (0.1*sin(2*pi*t)+0.12*t)*sin(pi*s)");
  const auto result       = compute(test::parameters_with(settings));
  EXPECT_EQ(result.time.status, Status::inverted);
  EXPECT_FALSE(result.cycles);
}

/// The watcher itself, shown a gait whose displacement repeats while its stretch drifts: a mode of the strain that does
/// not decay is not extrapolated, however well the displacement repeats.
TEST(CycleStop, DriftOfTheStretchIsSeen)
{
  const auto watch = [](const double ratio) {
    CycleStop stop({0.05, 1e-2}, 1e-12);
    unsigned int n = 0;
    double drift   = 0.;
    while (stop.next_time() < 1. && !stop.repeats())
    {
      const double t = stop.next_time() / 0.05;
      drift          = ratio == 1. ? 0.03 * t : 0.03 * (1. - std::pow(ratio, t)) / (1. - ratio);
      std::vector<double> u(CycleStop::n_pieces + 1);
      for (unsigned int i = 0; i <= CycleStop::n_pieces; ++i)
      {
        const double s = 1. * i / CycleStop::n_pieces;
        u[i]           = 0.01 * t +
               (0.03 * std::sin(2. * std::numbers::pi * t) - drift) * std::sin(std::numbers::pi * s) / std::numbers::pi;
      }
      stop.observe(u, 0.01 * t, std::nullopt, /*decay=*/1e3);
      n = static_cast<unsigned int>(std::floor(t));
    }
    return stop.repeats() ? n : 0;
  };
  EXPECT_EQ(watch(1.), 0u);
  EXPECT_EQ(watch(0.999), 0u);
  EXPECT_GT(watch(0.1), 2u);
  EXPECT_LT(watch(0.1), 6u);
}

TEST(CycleStop, WhenItIsWished)
{
  const auto wish = [](const test::Settings &settings, const bool has_pictures) {
    const auto parameters = test::parameters_with(settings);
    const Scene scene     = parameters.create_scene();
    return cycle_wish(parameters, scene, has_pictures).has_value();
  };
  const test::Settings wave = test::wave(-1., 0.1, 1., 20.), on = test::with(wave, "Time/Cycle stop = on");
  EXPECT_TRUE(wish(wave, 0));
  EXPECT_FALSE(wish(wave, 50)); // every output time is wanted
  EXPECT_FALSE(wish(test::wave(-1., 0.1, 1., 2.5), 0));
  EXPECT_FALSE(wish(test::with(wave, "Time/Cycle stop = off"), 0));
  EXPECT_THROW(wish(on, 50), InputError); // refused with the default of 50 snapshots
  EXPECT_TRUE(wish(test::with(on, "Output/Number of snapshots = 0"), 0));
  EXPECT_FALSE(wish(test::with(wave, "Time/Step control = fixed; Time/Initial step = 0.01"), 0));
  EXPECT_FALSE(wish(test::set("none; T = 20"), 0));
}

/// Many runs at once end when their cycles repeat, each at its own, as they do alone.
TEST(CycleStop, AmongManyRuns)
{
  std::vector<Task> tasks(3);
  tasks[0].parameters                 = test::parameters_with(test::wave(-1., 0.2, 1., 40.));
  tasks[1].parameters                 = test::parameters_with(test::wave(-1., 0.2, 1., 4.));
  tasks[2].parameters                 = test::parameters_with(test::wave(-1., 0.2, 1., 40.));
  tasks[2].parameters.time.cycle_stop = CycleStopMode::off;
  compute_all(tasks, 1e3, []() { return false; });
  for (std::size_t i = 0; i < tasks.size(); ++i)
  {
    const SimulationResult &together = tasks[i].computed.result, alone = compute(tasks[i].parameters);
    EXPECT_EQ(together.process.engine, "fused") << i;
    ASSERT_TRUE(together.error) << i;
    ASSERT_EQ(together.cycles.has_value(), i < 2) << i;
    if (together.cycles)
    {
      EXPECT_EQ(together.cycles->computed + together.cycles->extrapolated, i == 0 ? 40u : 4u) << i;
      EXPECT_LE(together.cycles->bound, together.error->total) << i;
      EXPECT_EQ(together.time.time, i == 0 ? 40. : 4.) << i;
    }
    EXPECT_LE(std::abs(together.displacement - alone.displacement), together.error->total) << i;
    EXPECT_NEAR(together.energy_balance->stress_work / alone.energy_balance->stress_work, 1., 1e-5) << i;
  }
  EXPECT_LE(std::abs(tasks[0].computed.result.displacement - tasks[2].computed.result.displacement),
            tasks[0].computed.result.error->total + tasks[2].computed.result.error->total);
  EXPECT_LT(5 * tasks[0].computed.result.time.steps, tasks[2].computed.result.time.steps);
}

// A standing wave is its own mirror image half a period later (the body slides to and fro), so that a whole stride
// displaces nothing; what is left of the start decays in the strides that are not computed.
TEST(CycleStop, TheLastComputedStrideHasABoundForTheStridesAfterIt)
{
  for (const char *p : {"1.05", "2", "3"})
  {
    const auto result = test::answer_to(
      test::set("Accuracy = 1e-3; gamma = 10; p = {}; T = 60; standing wave; Amplitude = 0.4; Wave number = 0.5", p));
    ASSERT_TRUE(result.cycles && result.gait) << p;
    const double stride = std::abs(result.gait->displacement);
    EXPECT_LE(stride, error_bound(result, "gait.displacement").value()) << p;
    EXPECT_LE(stride / result.gait->period, error_bound(result, "gait.speed").value()) << p;
    EXPECT_FALSE(error_bound(result, "gait.cost_of_transport.stress_power")) << p;
  }
}

/// A body that pulses alike at both ends goes nowhere, to round-off, which no run of many strides falls below: its
/// strides repeat all the same, whatever Accuracy is.
TEST(CycleStop, BodiesThatGoNowhereRepeat)
{
  const auto result = test::answer_to(
    test::set("Accuracy = 1e-9; p = 4; k = 2; T = 500; travelling wave; Amplitude = 0.5; Wave number = 0"));
  ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
  ASSERT_TRUE(result.cycles);
  EXPECT_LE(std::abs(result.displacement), result.error->total);
  EXPECT_LE(result.error->total, 500. * round_off_of_cycle * (result.stretch.max.value - 1.));
}
