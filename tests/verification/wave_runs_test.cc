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
