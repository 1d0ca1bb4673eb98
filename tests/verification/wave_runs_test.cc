// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Whole runs with the wave generators: against the paper's case, against formulas, by all numerics, and with jumps.
#include "../support/lane_runs.h"

#include <gtest/gtest.h>

using namespace crawler;
using test::run_with;
using test::Settings;

namespace
{
  Settings
  generator(const std::string &name, const Settings &entries, const double end_time, const double exponent = 2.)
  {
    std::string section = name;
    section[0]          = static_cast<char>(std::toupper(section[0]));
    Settings settings   = {{"Active stress/Generator", name},
                           {"Time/End time", test::text(end_time)},
                           {"Body/Anchoring exponent", test::text(exponent)}};
    for (const auto &[entry, value] : entries)
      settings.emplace_back("Active stress/" + section + "/" + entry, value);
    return settings;
  }

  double
  displacement(const Settings &settings)
  {
    const auto outcome = run_with(settings);
    EXPECT_EQ(outcome.result.time.status, Status::finished);
    return outcome.result.displacement;
  }

  const Settings two_pulses = generator(
    "pulse",
    {{"Amplitude", "0.4"}, {"Width", "0.2"}, {"Shape", "compact"}, {"Speed", "1.4"}, {"Repetition period", "1"}},
    2.);
} // namespace

/// doc/theory.md, table of reference numbers: chi = 0.4.
TEST(WaveRuns, ShapedWaveIsThePapersCase)
{
  auto settings = test::wave(-1., 0.4);
  settings.emplace_back("Active stress/Optimal wave/Shape", "expression");
  settings.emplace_back("Active stress/Optimal wave/Shape formula", "sin(2*pi*x)");
  EXPECT_NEAR(displacement(settings), 9.00725298e-2, 1e-6 * 9e-2);
}

TEST(WaveRuns, TravellingWaveIsItsFormula)
{
  const double wave    = displacement(generator("travelling wave", {{"Amplitude", "0.3"}, {"Wave number", "1.5"}}, 2.)),
               formula = displacement(generator("expression", {{"Active stress", "0.3*sin(2*pi*(1.5*s + t))"}}, 2.));
  EXPECT_NEAR(wave, formula, 1e-12);
}

TEST(WaveRuns, MirrorFlipsTheDisplacement)
{
  Settings back = two_pulses;
  back.emplace_back("Active stress/Pulse/Direction", "from head to tail");
  const double there = displacement(two_pulses);
  EXPECT_GT(std::abs(there), 0.01);
  EXPECT_NEAR(displacement(back), -there, 2e-7 * std::abs(there));
}

/// A contracted part grips (a < 0): against the pulse; it slips (a > 0): with it.
TEST(WaveRuns, FrictionDecidesTheDirectionOfPeristalsis)
{
  EXPECT_LT(displacement(two_pulses), 0.);
  Settings slips = two_pulses;
  slips.emplace_back("Body/Anchoring exponent", "0");
  EXPECT_GT(displacement(slips), 0.);
}

/// Both formulations, both kinds of meshes and the adaptive integrators agree to a few times the accuracy asked for.
TEST(WaveRuns, AllNumericsAgree)
{
  const std::string formulation = "Discretization/Formulation", mesh = "Discretization/Mesh",
                    integrator = "Time/Integrator", engine = "Time/Engine";
  const double reference = displacement(test::with(two_pulses, {{"Accuracy", "1e-8"}}));
  for (const Settings &numerics : {Settings{{formulation, "stretch"}},
                                   Settings{{mesh, "adaptive"}},
                                   Settings{{integrator, "bdf"}},
                                   Settings{{integrator, "radau 5"}},
                                   Settings{{engine, "petsc"}}})
  {
    const auto result =
      run_with(test::with(test::with(two_pulses, {{"Accuracy", "1e-5"}}), numerics), {.energy_balance = true}).result;
    EXPECT_EQ(result.time.status, Status::finished) << numerics.front().second;
    EXPECT_NEAR(result.displacement, reference, 5e-5 * std::abs(reference)) << numerics.front().second;
  }
}

/// The batch engine gives what a run gives.
TEST(WaveRuns, Batch)
{
  const Numerics numerics{.degree = 6, .n_cells = 24, .tolerance = 1e-7, .initial_step = 1e-4};
  const test::LaneRun run(two_pulses, "radau 9", numerics);
  const auto alone = run.simulate(Engine::petsc);
  const auto batch = test::run_alone(run);
  ASSERT_TRUE(batch.has_value());
  EXPECT_NEAR(batch->displacement, alone.displacement, 2. * numerics.tolerance);
}

/// Jumps in space at ends of cells: the accuracy that is asked for is reached.
TEST(WaveRuns, SharpWindowKeepsTheAccuracy)
{
  const auto windowed =
    generator("standing wave", {{"Amplitude", "0.3"}, {"Wave number", "0.5"}, {"Window start", "0.3"}}, 1.5);
  const double reference = displacement(test::with(windowed, {{"Accuracy", "1e-8"}}));
  EXPECT_GT(std::abs(reference), 1e-3);
  for (const double accuracy : {1e-4, 1e-6})
    EXPECT_NEAR(displacement(test::with(windowed, {{"Accuracy", test::text(accuracy)}})),
                reference,
                accuracy * std::abs(reference));
}

/// Jumps in time at ends of steps. The reference is the same with Accuracy 1e-4, 5.811437733e-4 +- 3.2e-8.
TEST(WaveRuns, SwitchingKeepsTheAccuracy)
{
  const auto square = generator(
    "standing wave", {{"Amplitude", "0.3"}, {"Wave number", "0.5"}, {"Profile", "square"}, {"Duty cycle", "0.3"}}, 1.5);
  EXPECT_NEAR(displacement(test::with(square, {{"Accuracy", "1e-3"}})), 5.811437733e-4, 1e-3 * 5.8e-4);
}
