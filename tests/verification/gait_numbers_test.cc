// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Gait numbers of runs against theory.md: sections 4, 5 and 10.
#include "../support/lane_runs.h"
#include "../support/test.h"

using namespace crawler;

namespace
{
  SimulationResult
  stride(const test::Settings &settings, const bool with_cycle_stop = false)
  {
    const RecordOptions options{.energy_balance = true,
                                .cycles         = with_cycle_stop ? std::optional(CycleWish{1., 1e-8}) : std::nullopt,
                                .gait           = GaitWish::any};
    return test::run_with(test::with(settings, "Accuracy = 1e-8"), options).result;
  }

  /// The gait of a run at Accuracy 1e-4, if the generator declares its period.
  std::optional<Gait>
  declared_gait(const test::Settings &settings)
  {
    return test::run_with(test::with(settings, "Accuracy = 1e-4"), {.gait = GaitWish::declared}).result.gait;
  }
} // namespace

TEST(GaitNumbers, ThoseOfFigure2)
{
  const auto result = stride(test::wave(-1., 0.4, 1., 20.));
  ASSERT_TRUE(result.gait);
  const Gait &gait = *result.gait;
  EXPECT_DOUBLE_EQ(gait.period, 1.);
  EXPECT_DOUBLE_EQ(gait.n_strides, 20.);
  // "first cycle 0.090073, each later cycle 0.090100"
  EXPECT_NEAR(gait.displacement, 0.090100, 0.5e-6);
  EXPECT_NEAR(gait.displacement, (1.801968240 - 9.0072529800e-2) / 19., 2e-9);
  EXPECT_STREQ(gait.direction(), "retrograde");
  EXPECT_NEAR(gait.wave->speed, -1., 0.02); // to leading order in chi
  // From stride to stride nothing is stored: the work is dissipated.
  EXPECT_NEAR(gait.energy_balance->elastic_energy, 0., 1e-9);
  EXPECT_NEAR(gait.energy_balance->stress_work, gait.energy_balance->dissipation, 1e-8);
  EXPECT_NEAR(gait.energy_balance->stress_work, (1.674733 - 0.083860120) / 19., 1e-6);
  EXPECT_LT(*result.gait_efficiency, 1.);
  EXPECT_NEAR(*gait.slip(), 1. - 0.0901, 2e-3);

  const auto early = stride(test::wave(-1., 0.4, 1., 20.), /*with_cycle_stop=*/true);
  ASSERT_TRUE(early.cycles && early.gait);
  EXPECT_NEAR(early.gait->displacement, gait.displacement, 1e-8);
  EXPECT_NEAR(early.gait->energy_balance->positive_work, gait.energy_balance->positive_work, 1e-5); // kinks
}

/// A run that ends early does so at the end of a stride, whatever rounding makes of that time.
TEST(GaitNumbers, RunsThatEndEarlyHaveALastStride)
{
  for (const double end_time : {5., 35., 36., 37., 65., 125., 300.})
  {
    const auto result = stride(test::wave(-1., 0.4, 1., end_time), /*with_cycle_stop=*/true);
    ASSERT_TRUE(result.cycles || end_time < 6.) << end_time;
    ASSERT_TRUE(result.gait) << end_time;
    EXPECT_NEAR(result.gait->displacement, 0.090100, 1e-6) << end_time;
  }
}

TEST(GaitNumbers, TheDirectionSwitchesWithA)
{
  for (const double a : {-1., 1.})
  {
    const auto result = stride(test::wave(a, 0.05, a < 0. ? 1. : -1., 2.));
    ASSERT_TRUE(result.gait);
    EXPECT_STREQ(result.gait->direction(), a < 0. ? "retrograde" : "prograde");
    EXPECT_GT(result.gait->displacement, 0.);
    EXPECT_NEAR(result.gait->wave->speed, a, 2e-3);
    EXPECT_NEAR(result.gait->wave->coherence, 1., 1e-3);
    // -L gamma c/a to leading order in chi.
    EXPECT_NEAR(*result.gait->cost_of_transport(result.gait->energy_balance->stress_work), 1., 0.02);
  }
  // The centre of mass stays where it is, so nothing is prograde or retrograde.
  const auto still = stride(test::wave(0., 0.1, 1., 2.));
  EXPECT_STREQ(still.gait->direction(), "none");
  EXPECT_FALSE(still.gait->cost_of_transport(1.));
  EXPECT_FALSE(still.gait_efficiency);
}

TEST(GaitNumbers, TheEnergiesOfAStrideAddUpWithThoseBefore)
{
  const double T   = 2.3; // the last stride starts where no cycle ends
  const auto whole = stride(test::wave(-1., 0.3, 1., T)), before = stride(test::wave(-1., 0.3, 1., T - 1.));
  EXPECT_NEAR(whole.gait->displacement, whole.displacement - before.displacement, 1e-9);
  EXPECT_NEAR(whole.gait->energy_balance->stress_work,
              whole.energy_balance->stress_work - before.energy_balance->stress_work,
              1e-8);
  EXPECT_NEAR(whole.gait->energy_balance->positive_work,
              whole.energy_balance->positive_work - before.energy_balance->positive_work,
              1e-4);
}

/// The generator says which wave runs; what is measured knows nothing of it. Actuators switch from segment to segment,
/// and between them there may be gaps.
TEST(GaitNumbers, SegmentsHaveTheWaveThatTheyDeclare)
{
  for (const unsigned int n : {8, 16, 32, 64})
    for (const double gap : {0., 0.3})
      for (const bool to_tail : {true, false})
      {
        const double lag = n == 16 ? 0.1 : 1. / n, duty = n == 8 ? 0.5 : 0.3;
        const auto gait =
          declared_gait(test::set("T = 3; segments; Number of segments = {}; Gap = {}; Phase lag = {}; "
                                  "Duty cycle = {}; Direction = {}; Rate limit = 1.5; Ramp duration = 0.5",
                                  n,
                                  gap,
                                  lag,
                                  duty,
                                  to_tail ? "from head to tail" : "from tail to head"));
        ASSERT_TRUE(gait && gait->wave) << n;
        const double pitch = (1. + gap) / (n + (n - 1) * gap), speed = (to_tail ? -1. : 1.) * pitch / lag;
        EXPECT_NEAR(gait->wave->speed, speed, 0.03 * std::abs(speed)) << n << " segments, gap " << gap;
        EXPECT_GT(gait->wave->coherence, 0.6) << n << " segments, gap " << gap;
        EXPECT_STREQ(gait->direction(), "retrograde");
        EXPECT_NEAR(*gait->slip(), 1. - std::abs(gait->speed() / speed), 1e-3);
      }
}

/// A pulse that crosses the body between two samples is not taken for what is left of it.
TEST(GaitNumbers, AWaveThatIsTooFastForTheSamplesIsAbsent)
{
  const auto pulse = [](const double speed, const double end_time) {
    return declared_gait(
      test::set("T = {}; pulse; Shape = compact; Width = 0.3; Repetition period = 2; Speed = {}", end_time, speed));
  };
  const auto slow = pulse(1.5, 4.);
  ASSERT_TRUE(slow && slow->wave_speed());
  EXPECT_NEAR(*slow->wave_speed(), 1.5, 0.1);
  for (const double end_time : {4., 4.01, 4.03, 4.05})
  {
    const auto fast = pulse(40., end_time);
    ASSERT_TRUE(fast) << end_time;
    EXPECT_FALSE(fast->wave) << end_time;
    EXPECT_FALSE(fast->slip()) << end_time;
    EXPECT_STREQ(fast->direction(), "none") << end_time;
  }
}

/// Side by side with others the last stride is the same as alone: in other units, where it starts in the middle of a
/// run, and where the active stress jumps before.
TEST(GaitNumbers, SideBySideTheyAreTheSame)
{
  const test::Settings units      = test::set("L = 2.5; gamma = 0.3; Active stress/Optimal wave/Wave speed = 2.5");
  const test::Settings travelling = test::set("travelling wave; Amplitude = 0.3; Ramp duration = 0.5");
  const test::Settings segments =
    test::set("segments; Gap = 0.1; Number of segments = 4; Rate limit = 1.5; Ramp duration = 0.5");
  const test::Settings pulses = test::set("pulse; Speed = 40; Repetition period = 2");
  const Numerics numerics     = {.degree = 6, .n_cells = 8, .tolerance = 1e-8, .initial_step = 1e-4};
  test::LaneRuns runs;
  const auto add = [&](const test::Settings &settings) {
    runs.push_back(std::make_unique<test::LaneRun>(settings, "radau 9", numerics));
  };
  add(test::wave(-1., 0.3));
  add(test::wave(-1., 0.3, 1., 2.5));
  add(test::with(test::wave(2., 0.2, -1., 3.), units));
  add(test::with(test::wave(-1., 0.3, 1., 4.), travelling));
  add(test::with(test::wave(-1., 0.3, 1., 4.), segments));
  add(test::with(test::wave(-1., 0.3, 1., 4.03), pulses)); // too fast for the samples
  add(test::wave(-1., 0.3, 1., 0.7));                      // no whole stride
  const RecordOptions options{.energy_balance = true, .gait = GaitWish::declared};
  const auto together = run_batch(test::entries(runs), options);
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    const auto alone = runs[i]->simulate(Engine::automatic, options);
    ASSERT_TRUE(together[i]) << i;
    ASSERT_EQ(together[i]->gait.has_value(), alone.gait.has_value()) << i;
    EXPECT_EQ(alone.gait.has_value(), i < 6) << i;
    EXPECT_NEAR(*together[i]->gait_efficiency, *alone.gait_efficiency, 1e-6);
    if (!alone.gait)
      continue;
    EXPECT_EQ(alone.gait->wave.has_value(), i != 5) << i;
    const auto here = test::numbers_of(*together[i]->gait), there = test::numbers_of(*alone.gait);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t j = 0; j < here.size(); ++j)
      EXPECT_NEAR(here[j], there[j], 2e-6 * std::max(1., std::abs(there[j]))) << i << ", number " << j;
  }
}

/// The first steps of a stiff body are shorter than what rounds the ends of strides.
TEST(GaitNumbers, AStrideIsTheWholeRunOfAStiffBody)
{
  const auto result =
    stride(test::set("k = 1e8; T = 1; travelling wave; Amplitude = 3e7; Wave number = 1; Frequency = 1"));
  ASSERT_TRUE(result.gait);
  EXPECT_EQ(result.gait->displacement, result.displacement);
  EXPECT_EQ(result.gait->energy_balance->stress_work, result.energy_balance->stress_work);
}
