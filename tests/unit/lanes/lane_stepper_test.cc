// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The fused engine carries out what the PETSc type "radau" does.
#include "../../support/lane_runs.h"
#include "../../support/test.h"

using namespace crawler;
using test::LaneRun;

namespace
{
  /// L, T, gamma and k are not 1.
  test::Settings
  in_other_units(test::Settings settings)
  {
    return test::with(std::move(settings),
                      test::set("L = 2; gamma = 0.3; k = 0.7; Active stress/Optimal wave/Wave speed = 1.5; T = 1.7"));
  }

  /// A stress that starts smoothly, with extremes inside and at the ends.
  constexpr const char *formula = "0.15*(1-exp(-(t/0.2)^2))*sin(2.2*(s+1.3*t)+0.4*cos(t))";

  struct Question
  {
    std::string integrator;
    double a;
    bool is_wave;
  };

  std::ostream &
  operator<<(std::ostream &out, const Question &question)
  {
    return out << question.integrator << ", a = " << question.a << (question.is_wave ? ", wave" : ", expression");
  }

  std::vector<Question>
  questions()
  {
    std::vector<Question> result;
    for (const std::string integrator : {"radau 5", "radau 9"})
      for (const double a : {-3., -1., -0.5, 0., 1., 2.5})
        for (const bool is_wave : {true, false})
          result.push_back({integrator, a, is_wave});
    return result;
  }

  void
  expect_near(const Extreme &a, const Extreme &b, const double value, const double place, const std::string &which)
  {
    EXPECT_NEAR(a.value, b.value, value) << which;
    EXPECT_NEAR(a.s, b.s, place) << which;
    EXPECT_NEAR(a.t, b.t, place) << which;
  }

  void
  expect_same(const SimulationResult &fused,
              const SimulationResult &petsc,
              const double tolerance,
              const bool same_steps = true)
  {
    ASSERT_EQ(fused.time.status, Status::finished);
    EXPECT_EQ(fused.process.engine, "fused") << "PETSc had to help";
    EXPECT_EQ(fused.time.time, petsc.time.time);
    EXPECT_LT(fused.residuals.net_friction, 1e-13);
    if (!same_steps)
    {
      EXPECT_NEAR(fused.displacement, petsc.displacement, 0.1 * tolerance);
      EXPECT_LT(fused.energy_balance->residual(), 100. * tolerance);
      return;
    }
    EXPECT_NEAR(fused.time.steps, petsc.time.steps, 0.1 * petsc.time.steps);
    EXPECT_NEAR(fused.displacement, petsc.displacement, 1e-3 * tolerance);
    const double energy    = tolerance * petsc.energy_balance->exchanged_work;
    const EnergyBalance &a = *fused.energy_balance, &b = *petsc.energy_balance;
    EXPECT_NEAR(a.stress_work, b.stress_work, 0.5 * energy);
    EXPECT_NEAR(a.dissipation, b.dissipation, 0.5 * energy);
    EXPECT_NEAR(a.positive_work, b.positive_work, 0.5 * energy);
    EXPECT_NEAR(a.exchanged_work, b.exchanged_work, 0.5 * energy);
    EXPECT_NEAR(a.end_work, b.end_work, 0.5 * energy);
    EXPECT_NEAR(a.elastic_energy, b.elastic_energy, 1e-3 * energy);
    EXPECT_LT(a.residual(), tolerance);
    // Places and times of an extreme are known to the root of the error of its value.
    expect_near(fused.stretch.min, petsc.stretch.min, 0.3 * tolerance, 0.1 * std::sqrt(tolerance), "smallest");
    expect_near(fused.stretch.max, petsc.stretch.max, 0.3 * tolerance, 0.1 * std::sqrt(tolerance), "largest");
  }

  class LaneStepperTest : public ::testing::TestWithParam<Question>
  {
  };
} // namespace

TEST_P(LaneStepperTest, GivesWhatPetscGives)
{
  const auto [integrator, exponent, is_wave] = GetParam();
  constexpr double tolerance                 = 1e-7;
  const LaneRun run(in_other_units(is_wave ? test::wave(exponent, 0.25) : test::expression(exponent, formula)),
                    integrator,
                    {.degree = 5, .n_cells = 6, .tolerance = tolerance, .initial_step = 1e-4});
  const SimulationResult petsc = run.simulate(Engine::petsc), single = run.simulate(Engine::automatic);
  const auto batch = test::run_alone(run);
  ASSERT_TRUE(batch);
  EXPECT_EQ(petsc.process.engine, "petsc");
  expect_same(single, petsc, tolerance);
  expect_same(*batch, petsc, tolerance);
}

/// Each law of general bodies and grounds that the engine knows, or asks its host for. Of a batch of different bodies
/// each is the same to the last bit as alone.
TEST(LaneStepper, GeneralBodiesAreThoseOfPetsc)
{
  constexpr double tolerance = 1e-7;
  const auto feedback        = [](const std::string &more) {
    return test::set("strain feedback; Active stress = {}{}", formula, more);
  };
  const test::Settings modulus   = {{"Body/Elastic modulus profile", "1+0.3*s"}},
                       profile   = {{"Body/Friction profile", "1.2-0.3*s"}},
                       ground    = {{"Ground/Profile", "1+0.2*tanh(x)"}},
                       law       = {{"Ground/Friction law", "expression"}, {"Ground/Expression", "0.3+0.7/w^1.5"}},
                       direction = {{"Ground/Backward ratio", "3"}, {"Ground/Switching velocity", "0.2"}};
  test::Settings all             = feedback("-0.1*(w-1)+0.02*w_t*w");
  for (const test::Settings &more : {modulus, profile, ground, law, direction})
    all = test::with(all, more);
  unsigned int n_batches = 0;
  for (const test::Settings &laws :
       {modulus, profile, ground, law, direction, feedback("-0.2*(w-1)+0.1*(w-1)^2"), feedback("+0.05*w_t"), all})
    for (const std::string integrator : {"radau 5", "radau 9"})
    {
      test::LaneRuns runs;
      for (const double a : {-1.5, 0., 2.})
        runs.push_back(
          std::make_unique<LaneRun>(in_other_units(test::with(test::expression(a, formula), laws)),
                                    integrator,
                                    Numerics{.degree = 5, .n_cells = 6, .tolerance = tolerance, .initial_step = 1e-4}));
      const auto together = run_batch(test::entries(runs), {.energy_balance = true});
      for (std::size_t i = 0; i < runs.size(); ++i)
      {
        SCOPED_TRACE(laws.back().first + " = " + laws.back().second + ", " + integrator + ", body " +
                     std::to_string(i));
        const SimulationResult petsc = runs[i]->simulate(Engine::petsc);
        // Where friction turns sharply Newton's method of PETSc takes the longer steps.
        const bool same_steps = laws.back().first != direction.back().first;
        expect_same(runs[i]->simulate(Engine::automatic), petsc, tolerance, same_steps);
        ASSERT_TRUE(together[i]);
        expect_same(*together[i], petsc, tolerance, same_steps);
        const auto alone = test::run_alone(*runs[i]);
        ASSERT_TRUE(alone);
        EXPECT_TRUE(test::same_bits(test::numbers_of(*together[i]), test::numbers_of(*alone)));
        ++n_batches;
      }
    }
  EXPECT_EQ(n_batches, 48u);
}

/// A run stops after the step at which it is told to, on both engines.
TEST(LaneStepper, ARunStopsAtOnce)
{
  const LaneRun run(
    test::wave(-1., 0.3), "radau 5", {.degree = 5, .n_cells = 5, .tolerance = 1e-7, .initial_step = 1e-4});
  const SimulationResult whole = run.simulate(Engine::automatic);
  for (const Engine engine : {Engine::petsc, Engine::automatic})
    for (const unsigned int most : {1u, 2u, 17u})
    {
      TimeParameters time = run.parameters.time;
      time.engine         = engine;
      Simulation simulation(MPI_COMM_WORLD, run.scene, time, run.numerics);
      unsigned int asked = 0;
      const auto stopped = simulation.run({}, {.energy_balance = true}, {}, [&] { return ++asked < most; });
      EXPECT_EQ(stopped.time.status, Status::stopped) << engine;
      EXPECT_EQ(asked, most) << engine; // the initial state asks, too
      EXPECT_EQ(stopped.time.steps, most - 1) << engine;
      EXPECT_LT(stopped.time.time, 1.);
      // The next runs of the same object know nothing of it.
      const auto next = simulation.run({}, {.energy_balance = true});
      const auto last = simulation.run({}, {.energy_balance = true});
      EXPECT_EQ(next.time.steps, whole.time.steps) << engine;
      EXPECT_TRUE(test::same_bits(test::numbers_of(next), test::numbers_of(last))) << engine;
    }
}

INSTANTIATE_TEST_SUITE_P(AllExponents, LaneStepperTest, ::testing::ValuesIn(questions()));
