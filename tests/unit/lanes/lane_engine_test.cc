// SPDX-License-Identifier: LGPL-2.1-or-later
//
// No operation of the engine mixes lanes: what comes out for a body is the same to the last bit, whatever is computed
// beside it.
#include "../../support/lane_runs.h"
#include "../../support/test.h"

#include <crawler/lanes/lane_control.h>

using namespace crawler;
using test::LaneRun;
using test::LaneRuns;
using test::wave;

namespace
{
  void
  add(LaneRuns &runs,
      const test::Settings &settings,
      const std::string &integrator = "radau 9",
      const Numerics &numerics      = {.degree = 5, .n_cells = 5, .tolerance = 1e-7, .initial_step = 1e-4})
  {
    runs.push_back(std::make_unique<LaneRun>(settings, integrator, numerics));
  }

  const test::Settings other_units = test::set("L = 2.5; gamma = 0.3; Active stress/Optimal wave/Wave speed = 2");

  /// Bodies that have little in common: friction by products and by powers, some that are given up in different ways.
  LaneRuns
  mixture(const std::string &integrator = "radau 9")
  {
    LaneRuns runs;
    add(runs, wave(-1., 0.3), integrator);
    add(runs, wave(-1., 0.3), integrator, {.degree = 5, .n_cells = 5, .tolerance = 1e-5, .initial_step = 1e-2});
    add(runs, wave(0., 0.2), integrator);
    add(runs, wave(2., 0.3, -1., 0.7), integrator);
    add(runs, wave(-3., 0.3, 1., 1., 10.), integrator);
    add(runs, wave(15., 0.05), integrator);
    add(runs, wave(16., 0.05), integrator); // no longer by products
    add(runs, wave(-0.5, 0.2), integrator);
    add(runs, wave(2.5, 0.2, 0.5, 3.), integrator);
    add(runs, wave(-1., 0.3, 1., 1., 0.01), integrator);
    add(runs, test::with(wave(-1.5, 0.2, 2., 2.), other_units), integrator);
    add(runs, wave(-1., 0.7), integrator);             // squeezed to nothing
    add(runs, wave(1., 0.9, 1., 2., 0.7), integrator); // inverts
    add(runs, test::with(wave(-1., 0.2), {{"Time/Maximum number of steps", "5"}}), integrator);
    add(runs, test::expression(-1., "0.2*sin(2*pi*(s+t))*(1-exp(-30*t))"), integrator);
    add(runs, test::expression(0.5, "0.2*cos(2*pi*s)*sin(7*t)^2", 2.), integrator);
    add(runs, test::expression(-2., "0"), integrator); // at rest
    return runs;
  }
} // namespace

TEST(LaneEngine, TheProcessorsBestEngineIsUsed)
{
  EXPECT_STREQ(batch_engine().instruction_set, test::batch_engines().back()->instruction_set);
  EXPECT_STREQ(single_engine().instruction_set, batch_engine().instruction_set);
  EXPECT_EQ(single_engine().lanes, 1u);
  EXPECT_EQ(batch_engine("abacus"), nullptr);
}

TEST(LaneEngine, AResultDoesNotDependOnWhatSharesTheBatch)
{
  std::mt19937 random(1);
  for (const LaneEngine *engine : test::batch_engines())
    for (const std::string integrator : {"radau 5", "radau 9"})
      for (const bool energy_balance : {true, false})
      {
        const LaneRuns runs = mixture(integrator);
        const RecordOptions options{.energy_balance = energy_balance, .gait = GaitWish::declared};
        const auto all        = test::entries(runs);
        const auto together   = run_batch(all, options, {}, *engine);
        unsigned int finished = 0;
        for (std::size_t i = 0; i < runs.size(); ++i)
        {
          const auto alone = test::run_alone(*runs[i], options, *engine);
          EXPECT_TRUE(test::same_bits(alone, together[i])) << engine->instruction_set << ", run " << i;
          finished += alone.has_value();
        }
        EXPECT_EQ(finished, runs.size() - 3);
        std::vector<std::size_t> order(2 * runs.size());
        for (std::size_t i = 0; i < order.size(); ++i)
          order[i] = i % runs.size();
        std::shuffle(order.begin(), order.end(), random);
        std::vector<BatchRun> shuffled;
        for (const std::size_t i : order)
          shuffled.push_back(all[i]);
        const auto mixed = run_batch(shuffled, options, {}, *engine);
        for (std::size_t i = 0; i < order.size(); ++i)
          EXPECT_TRUE(test::same_bits(mixed[i], together[order[i]])) << engine->instruction_set << ", run " << order[i];
      }
}

/// Runs of different methods are batches of their own; the answers come back in the order of the questions.
TEST(LaneEngine, MethodsMayBeMixed)
{
  LaneRuns runs;
  for (const unsigned int degree : {1u, 2u, 3u, 4u, 5u, 6u, 7u, 8u})
    for (const unsigned int cells : {1u, 3u})
      for (const std::string integrator : {"radau 5", "radau 9"})
        add(runs,
            wave(-1., 0.1),
            integrator,
            {.degree = degree, .n_cells = cells, .tolerance = 1e-6, .initial_step = 1e-3});
  const auto results = run_batch(test::entries(runs), {.energy_balance = true});
  for (std::size_t i = 0; i < runs.size(); ++i)
  {
    ASSERT_TRUE(results[i]) << i;
    EXPECT_EQ(results[i]->process.mesh.most_cells, runs[i]->numerics.n_cells);
    EXPECT_TRUE(test::same_bits(results[i], test::run_alone(*runs[i]))) << i;
  }
}

TEST(LaneEngine, AnEmptyBatchIsDone)
{
  EXPECT_TRUE(run_batch({}, {.energy_balance = true}).empty());
}

namespace
{
  /// The same steps, and errors that are small against the tolerance: what Newton's method leaves is 0.01 of it.
  void
  expect_agreement(const LaneRuns &runs, const LaneEngine &one, const LaneEngine &other)
  {
    const std::string which =
      fmt::format("{} x {} and {} x {}", one.instruction_set, one.lanes, other.instruction_set, other.lanes);
    const auto a = run_batch(test::entries(runs), {.energy_balance = true}, {}, one),
               b = run_batch(test::entries(runs), {.energy_balance = true}, {}, other);
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
      ASSERT_EQ(a[i].has_value(), b[i].has_value()) << which << ", run " << i;
      if (!a[i])
        continue;
      const double tolerance = runs[i]->numerics.tolerance;
      EXPECT_EQ(a[i]->time.steps, b[i]->time.steps) << which << ", run " << i;
      EXPECT_NEAR(a[i]->displacement, b[i]->displacement, 0.01 * tolerance) << which << ", run " << i;
      // A place where the stretch is extreme is known to the root of the error of the stretch, and one of two places
      // that mirror each other is chosen by round-off.
      SimulationResult p = *a[i], q = *b[i];
      for (const auto extreme : {&SimulationResult::Stretch::min, &SimulationResult::Stretch::max})
      {
        const double distance = std::abs((p.stretch.*extreme).s - (q.stretch.*extreme).s),
                     mirrored = std::abs((p.stretch.*extreme).s + (q.stretch.*extreme).s - runs[i]->scene.body.length);
        EXPECT_LE(std::min(distance, mirrored), std::sqrt(tolerance)) << which << ", run " << i;
        EXPECT_NEAR((p.stretch.*extreme).t, (q.stretch.*extreme).t, std::sqrt(tolerance)) << which << ", run " << i;
        (q.stretch.*extreme).s = (p.stretch.*extreme).s;
        (q.stretch.*extreme).t = (p.stretch.*extreme).t;
      }
      const auto x = test::numbers_of(p), y = test::numbers_of(q);
      for (std::size_t j = 0; j < x.size(); ++j)
        EXPECT_NEAR(x[j], y[j], 0.1 * tolerance * std::max(1., std::abs(x[j]))) << which << ", run " << i << ", " << j;
    }
  }
} // namespace

/// Round-off differs between the instruction sets and numbers of lanes, by fused products and variants of pow.
TEST(LaneEngine, InstructionSetsAgree)
{
  for (const std::string integrator : {"radau 5", "radau 9"})
  {
    const LaneRuns runs = mixture(integrator);
    for (const LaneEngine *engine : test::batch_engines())
    {
      expect_agreement(runs, *engine, *test::batch_engines().front());
      expect_agreement(runs, *engine, single_engine());
    }
  }
}

/// The cells of one body are side by side in groups of a register's width, the last of which is not full.
TEST(LaneEngine, CellsSideBySideAreThoseOfABodyInALane)
{
  LaneRuns runs;
  for (unsigned int degree = 1; degree <= 8; ++degree)
    for (const unsigned int cells : {1u, 3u, 4u, 7u, 8u, 16u, 21u})
      add(runs,
          wave(degree % 2 == 0 ? -1. : 1.3, 0.3),
          degree % 3 == 0 ? "radau 9" : "radau 5",
          {.degree = degree, .n_cells = cells, .tolerance = 1e-6, .initial_step = 1e-3});
  expect_agreement(runs, *test::batch_engines().back(), single_engine());
}

/// A Simulation has the engine with one lane. In a batch that engine takes the same steps to the last bit.
TEST(LaneEngine, ASimulationTakesTheStepsOfABatchWithOneLane)
{
  for (const std::string integrator : {"radau 5", "radau 9"})
  {
    const LaneRuns runs = mixture(integrator);
    const auto results  = run_batch(test::entries(runs), {.energy_balance = true}, {}, single_engine());
    for (std::size_t i = 0; i < runs.size(); ++i)
    {
      if (!results[i])
        continue;
      const SimulationResult simulated = runs[i]->simulate(Engine::automatic);
      const TimeOutcome &a = results[i]->time, &b = simulated.time;
      EXPECT_TRUE(test::same_bits({a.time, a.step_size}, {b.time, b.step_size})) << i;
      EXPECT_EQ(a.steps, b.steps) << i;
      EXPECT_EQ(a.rejected_steps, b.rejected_steps) << i;
      EXPECT_EQ(a.newton_iterations, b.newton_iterations) << i;
      EXPECT_NEAR(results[i]->displacement, simulated.displacement, 1e-14) << i; // summed in another order
    }
  }
}

TEST(LaneEngine, ABatchStopsAtOnce)
{
  LaneRuns runs = mixture("radau 5");
  for (auto &run : mixture("radau 9"))
    runs.push_back(std::move(run));
  for (const LaneEngine *engine : test::batch_engines())
  {
    const auto whole = run_batch(test::entries(runs), {.energy_balance = true}, {}, *engine);
    for (const unsigned int most : {1u, 10u, 400u})
    {
      unsigned int asked = 0;
      const auto results = run_batch(
        test::entries(runs), {.energy_balance = true}, [&] { return ++asked < most; }, *engine);
      EXPECT_EQ(asked, most) << "asked again after a no";
      unsigned int answers = 0;
      for (std::size_t i = 0; i < runs.size(); ++i)
        if (results[i])
        {
          ++answers;
          EXPECT_TRUE(test::same_bits(results[i], whole[i])) << i;
        }
      EXPECT_EQ(answers > 0, most == 400u);
      EXPECT_LT(answers, runs.size() / 2);
    }
  }
}

/// The filter of the error estimate may lose the stretch; longer steps for ever are no way out.
TEST(LaneEngine, AStepThatCannotBeJudgedIsMadeShorter)
{
  generic::Lane lane;
  lane.h     = 0.1;
  lane.error = std::numeric_limits<double>::quiet_NaN();
  lane.control_step(3, /*keeps_try=*/false);
  EXPECT_FALSE(lane.accepted);
  EXPECT_LT(lane.next, lane.h);
  EXPECT_EQ(lane.rejected, 1u);
}
