// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Active stresses that jump: full orders where the jumps are declared, and lost orders where they are not.
#include "../support/lane_runs.h"
#include "../support/observed_order.h"
#include "../support/test.h"
#include "../support/with_breaks.h"

#include <crawler/accuracy/pilots.h>
#include <crawler/base/grid_samples.h>
#include <crawler/time/integrators.h>

using namespace crawler;
using test::LaneRun;

namespace
{
  std::unique_ptr<LaneRun>
  jumping(const test::Settings &settings,
          const std::string &integrator,
          const Numerics &numerics,
          const std::vector<double> &in_space,
          const std::vector<double> &in_time)
  {
    auto run = std::make_unique<LaneRun>(settings, integrator, numerics);
    run->scene.active_stress =
      std::make_unique<test::WithBreaks>(std::move(run->scene.active_stress), in_space, in_time);
    return run;
  }

  double
  distance(const std::vector<double> &list, const double value)
  {
    double least = HUGE_VAL;
    for (const double entry : list)
      least = std::min(least, std::abs(entry - value));
    return least;
  }
} // namespace

/// The stress jumps at s = 0.37 L and grows from 0 so smoothly that nothing else is rough.
TEST(Jumps, InSpaceKeepTheOrder)
{
  const auto displacement = [](
                              const Formulation form, const unsigned int q, const unsigned int n, const bool declared) {
    const auto run    = jumping(test::expression(-1., "sin(pi*t/2)^8*(s<0.37 ? 0.5*cos(2*s) : -0.4*sin(3*s))", 0.9),
                             "radau 9",
                             {.degree = q, .n_cells = n, .tolerance = 1e-13, .initial_step = 1e-3, .formulation = form},
                             declared ? std::vector<double>{0.37} : std::vector<double>(),
                             {});
    const auto result = run->simulate(Engine::automatic, {});
    EXPECT_EQ(result.time.status, Status::finished) << result.time.message;
    EXPECT_EQ(result.process.mesh.most_cells, n);
    return result.displacement;
  };
  const double exact = displacement(Formulation::position, 8, 20, true);
  for (const auto &[form, q, cells] : {std::tuple(Formulation::position, 2u, std::vector<double>{8, 16, 32}),
                                       std::tuple(Formulation::position, 4u, std::vector<double>{3, 5, 8}),
                                       std::tuple(Formulation::stretch, 1u, std::vector<double>{30, 60, 120})})
  {
    std::vector<double> declared, hidden;
    for (const double n : cells)
    {
      declared.push_back(std::abs(displacement(form, q, static_cast<unsigned int>(n), true) - exact));
      hidden.push_back(std::abs(displacement(form, q, static_cast<unsigned int>(n), false) - exact));
    }
    const double order = test::observed_order("declared", cells, declared),
                 lost  = test::observed_order("hidden", cells, hidden);
    EXPECT_GE(order, 2. * q - 0.4);
    EXPECT_LT(lost, form == Formulation::position ? 2.5 : 1.5);
    EXPECT_GT(hidden.back(), (form == Formulation::position ? 100. : 10.) * declared.back());
  }
}

/// The stress, or only its derivative, jumps at t = 3/8, where a step ends in any case. With a tolerance that any step
/// meets all steps have the largest length; for a = 0 the equation is linear and Newton's method exact. The body is not
/// stiff: else the order is reduced.
TEST(Jumps, InTimeKeepTheOrder)
{
  for (const std::string after : {"0.02*cos(2*t)", "0.02*sin(pi*0.375/2)^8*(1+3*(t-0.375))"})
  {
    const bool of_value = after == "0.02*cos(2*t)";
    const auto energy =
      [&](const std::string &integrator, const std::string &engine, const unsigned int n, const bool declared) {
        const auto run =
          jumping(test::expression(0., "cos(3*(s-2*t))*(t<0.375 ? 0.02*sin(pi*t/2)^8 : " + after + ")", 1., 0.05),
                  integrator,
                  {.degree = 4, .n_cells = 1, .tolerance = 1e3, .initial_step = 1. / n, .step_limits = {{0., 1. / n}}},
                  {},
                  declared ? std::vector<double>{0.375} : std::vector<double>());
        const auto result =
          engine == "batch" ? *test::run_alone(*run) : run->simulate(from_word<Engine>(engine).value());
        EXPECT_LE(result.time.steps, n + 1) << integrator << " " << engine;
        return result.energy_balance->elastic_energy;
      };
    const double exact = energy("radau 9", "batch", 400, true);
    for (const auto &[integrator, order, steps] : {std::tuple("radau 5", 5., std::vector<double>{24, 48, 96}),
                                                   std::tuple("radau 9", 9., std::vector<double>{8, 16})})
      for (const std::string engine : {"batch", "automatic", "petsc"})
      {
        std::vector<double> declared, hidden;
        for (const double n : steps)
        {
          declared.push_back(std::abs(energy(integrator, engine, static_cast<unsigned int>(n), true) / exact - 1.));
          hidden.push_back(std::abs(energy(integrator, engine, static_cast<unsigned int>(n), false) / exact - 1.));
        }
        const double observed = test::observed_order(integrator, steps, declared),
                     lost     = test::observed_order("hidden", steps, hidden);
        // A derivative that jumps excites all modes of the mesh, the stiff ones with a reduced order.
        EXPECT_GE(observed, of_value || order < 9. ? order - 0.4 : 5.6) << integrator << " " << engine;
        if (of_value)
        {
          EXPECT_LT(lost, 1.5) << integrator << " " << engine;
        }
      }
  }
}

namespace
{
  // Two segments that switch: 0.4 of the body with one phase, the rest with another.
  const std::string robot               = "0.2*(s<0.4 ? (mod(2*t,1)<0.5 ? 1 : -1) : (mod(2*t+0.25,1)<0.5 ? 1 : -1))";
  const std::vector<double> robot_times = {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875};
} // namespace

/// Every integrator, both forms, uniform, graded and adaptive meshes, and the engines, come to the same displacement,
/// and their energy balances close.
TEST(Jumps, AreTheSameForAllMethods)
{
  const Numerics fine  = {.degree = 6, .n_cells = 5, .tolerance = 1e-10, .initial_step = 1e-9, .grading = {6, 0.25}};
  const auto reference = test::run_alone(*jumping(test::expression(-1., robot), "radau 9", fine, {0.4}, robot_times));
  ASSERT_TRUE(reference);
  const auto compare = [&](const std::string &name, const SimulationResult &result, const double within) {
    ASSERT_EQ(result.time.status, Status::finished) << name << ": " << result.time.message;
    EXPECT_NEAR(result.displacement / reference->displacement, 1., within) << name;
    EXPECT_LT(result.energy_balance->residual(), 10. * within) << name;
  };
  for (const Integrator &method : integrators())
  {
    Numerics numerics  = fine;
    numerics.tolerance = 1e-9;
    const auto run     = jumping(test::expression(-1., robot), method.name, numerics, {0.4}, robot_times);
    compare(method.name, run->simulate(Engine::petsc), 1e-5);
  }
  const auto with = [&](const auto &change) {
    Numerics numerics = fine;
    change(numerics);
    return jumping(test::expression(-1., robot), "radau 5", numerics, {0.4}, robot_times);
  };
  compare("fused", with([](Numerics &) {})->simulate(Engine::automatic), 1e-7);
  const auto stretch =
    jumping(test::with(test::expression(-1., robot), {{"Discretization/Formulation", "stretch"}, {"Accuracy", "1e-5"}}),
            "automatic",
            {},
            {0.4},
            robot_times);
  const auto by_meshes = test::run_with(stretch->parameters, stretch->scene).result;
  compare("stretch", by_meshes, by_meshes.error.value().total / std::abs(by_meshes.displacement));
  compare("adaptive mesh",
          with([](Numerics &n) {
            n.grading   = {};
            n.n_cells   = 10;
            n.mesh      = {1e-7, 1e-6};
            n.tolerance = 1e-8;
          })->simulate(Engine::petsc),
          1e-4);
}

/// A thousand switchings: steps end at each of them, output times are output times and nothing else is.
TEST(Jumps, ManyInTime)
{
  constexpr unsigned int n         = 1000;
  const auto switches              = equal_parts(0., 2., n); // 0 and the end time are admitted
  const auto run                   = jumping(test::expression(-1., "0.1*s*(1-s)*(2-s)*(mod(500*t,2)<1 ? 1 : -1)", 2.),
                           "radau 5",
                           {.degree = 4, .n_cells = 6, .tolerance = 1e-6, .initial_step = 2e-5},
                           {},
                           switches);
  const std::vector<double> wanted = {1e-9, 0.1, 0.5, 0.5 + 1e-9, 0.7001, 1., 2.};
  std::vector<double> displacements;
  for (const Engine engine : {Engine::automatic, Engine::petsc})
  {
    TimeParameters time = run->parameters.time;
    time.engine         = engine;
    Simulation simulation(MPI_COMM_WORLD, run->scene, time, run->numerics);
    std::vector<double> steps, output_times;
    const auto observers          = watched_by([&](const Snapshot &snapshot) {
      if (snapshot.is_step_end)
        steps.push_back(snapshot.step.time);
      if (snapshot.pictures.is_snapshot)
        output_times.push_back(snapshot.step.time);
    });
    const SimulationResult result = simulation.run({wanted, {}, 2.}, {.energy_balance = true}, observers);
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    EXPECT_EQ(result.time.steps + 1, steps.size());
    EXPECT_TRUE(std::is_sorted(steps.begin(), steps.end()));
    for (const double t : switches)
      EXPECT_LT(distance(steps, t), 1e-14 + 1e-15 * t);
    ASSERT_EQ(output_times.size(), wanted.size() + 1);
    for (std::size_t i = 0; i < wanted.size(); ++i)
      EXPECT_EQ(output_times[i + 1], wanted[i]);
    EXPECT_LT(result.energy_balance->residual(), 1e-5);
    displacements.push_back(result.displacement);
  }
  const auto batch = test::run_alone(*run);
  ASSERT_TRUE(batch);
  EXPECT_NEAR(run->simulate(Engine::automatic).displacement / batch->displacement, 1., 1e-12);
  for (const double displacement : displacements) // output times make other steps
    EXPECT_NEAR(displacement / batch->displacement, 1., 1e-5);
}

/// An end inverts at the moment when the stress jumps there, and that is what is reported.
TEST(Jumps, InvertAnEndWhenTheyHappen)
{
  for (const Engine engine : {Engine::automatic, Engine::petsc})
  {
    const auto run    = jumping(test::expression(1., "(t<0.3 ? 0.1*t : 1.2)*(1-s)^2"),
                             "radau 5",
                             {.degree = 4, .n_cells = 6, .tolerance = 1e-6, .initial_step = 1e-4},
                             {},
                             {0.3});
    const auto result = run->simulate(engine);
    EXPECT_EQ(result.time.reason, "inverted_at_end") << result.time.message;
    ASSERT_TRUE(result.inversion);
    EXPECT_DOUBLE_EQ(result.inversion->t, 0.3);
    EXPECT_EQ(result.inversion->s, 0.);
    EXPECT_FALSE(test::run_alone(*run));
  }
}

/// A sudden start: each level of the grading divides the error by the square of the ratio, until the mesh is good.
TEST(Jumps, GradedMeshesConvergeExponentially)
{
  const auto displacement = [](const unsigned int levels) {
    const auto run =
      jumping(test::expression(-1., "0.3*cos(2*pi*(s+t))"),
              "radau 9",
              {.degree = 8, .n_cells = 8, .tolerance = 1e-11, .initial_step = 1e-11, .grading = {levels, 0.25}},
              {},
              {});
    const auto result = test::run_alone(*run, {.energy_balance = false});
    EXPECT_TRUE(result) << levels;
    return result->displacement;
  };
  const double exact = displacement(8);
  std::vector<double> errors;
  for (const unsigned int levels : {0u, 2u, 4u, 6u})
  {
    errors.push_back(std::abs(displacement(levels) / exact - 1.));
    if (levels > 0)
    {
      EXPECT_LT(errors.back(), errors[errors.size() - 2] / 50.) << levels;
    }
  }
}

/// A stress that starts and goes on smoothly needs no graded mesh.
TEST(Jumps, AloneGetGradedMeshes)
{
  const auto smooth = jumping(test::wave(-1., 0.2), "automatic", {}, {}, {});
  EXPECT_EQ(choose_numerics({smooth->parameters, smooth->scene, {}, MPI_COMM_WORLD})->numerics.grading.levels, 0u);
}

/// Errors of the time steps, multiplied by the cycles that are extrapolated, are not taken for those of the mesh; nor
/// are steps so long that these errors empty a stretch.
TEST(Jumps, OfManyCyclesNeedNoMoreCells)
{
  for (const auto &[scene, accuracy] : {std::pair("p = 2; k = 3; T = 800; segments", 1e-6),
                                        std::pair("p = 2; k = 0.5; T = 200; segments; Number of segments = 4", 1e-4)})
  {
    test::LaneRun run(test::set(scene), "automatic", {});
    run.parameters.accuracy = accuracy;
    const auto choice       = choose_numerics({run.parameters, run.scene, {}, MPI_COMM_WORLD});
    EXPECT_GE(choice->numerics.grading.levels, 1u) << scene;
    EXPECT_LT(choice->numerics.n_cells, 100u) << scene;
  }
}

/// Pilots of a scene whose cycles should repeat are given up if they do not in many steps.
TEST(Pilots, ThatDoNotSettleAreGivenUp)
{
  const test::LaneRun run(test::set("T = 5000; expression; Active stress = 0.1*sin(2*pi*(s+t))*(1+0.1*sin(3.883*t))"),
                          "automatic",
                          {.degree = 4, .n_cells = 4, .tolerance = 1e-4, .initial_step = 1e-5});
  const KeepGoing keep_going;
  Pilots pilots({run.parameters, run.scene, keep_going});
  pilots.must_settle = true;
  EXPECT_THROW(pilots.run(run.numerics, ResolutionWish::size), PilotsUnsettled);
}

/// An initial stretch that does not fit the ends makes layers like a stress that starts suddenly, and gets the same
/// meshes.
TEST(Jumps, AreMadeByAnInitialStretch)
{
  const test::Settings scene =
    test::with(test::expression(-1., "0.3*sin(2*pi*(s+t))*s*(1-s)*4"), {{"Body/Initial stretch", "1+0.2*s"}});
  const test::LaneRun fine(
    scene, "radau 9", {.degree = 8, .n_cells = 12, .tolerance = 1e-12, .initial_step = 1e-14, .grading = {8, 0.4}});
  const SimulationResult exact = fine.simulate(Engine::automatic);
  ASSERT_EQ(exact.time.status, Status::finished);
  for (const double accuracy : {1e-4, 1e-8})
  {
    test::LaneRun run(scene, "automatic", {});
    run.parameters.accuracy       = accuracy;
    run.numerics                  = choose_numerics({run.parameters, run.scene, {}, MPI_COMM_WORLD})->numerics;
    const SimulationResult result = run.simulate(Engine::automatic);
    EXPECT_GT(run.numerics.grading.levels, 0u);
    ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
    EXPECT_EQ(result.process.engine, "fused");
    EXPECT_NEAR(result.displacement, exact.displacement, accuracy * std::abs(exact.displacement));
  }
}
