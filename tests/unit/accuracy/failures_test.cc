// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Whatever is thrown while a body is computed, the run has an end with a name.
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/accuracy/error_estimate.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/petsc_object.h>
#include <crawler/scene/known_stress.h>
#include <crawler/time/failure.h>

using namespace crawler;

namespace
{
  /// A wave that throws from a time on, or on meshes with more points than allowed.
  class Throwing : public ActiveStress
  {
  public:
    Throwing(const std::function<void()> &fault, const double from, const std::size_t max_points = 1000000)
      : fault_(fault)
      , from_(from)
      , max_points_(max_points)
    {
    }

    std::unique_ptr<ActiveStressAtPoints>
    at(const std::vector<double> &points) const override
    {
      if (points.size() > max_points_)
        fault_();
      return stress_at_points([this, points](const double t, const std::span<double> m) {
        if (t >= from_)
          fault_();
        for (std::size_t i = 0; i < m.size(); ++i)
          m[i] = 0.2 * (1. - std::exp(-10. * t * t)) * std::sin(2. * std::numbers::pi * (points[i] + t));
      });
    }

  private:
    const std::function<void()> fault_;
    const double from_;
    const std::size_t max_points_;
  };

  Scene
  scene_with(const Parameters &parameters, std::unique_ptr<ActiveStress> stress)
  {
    Scene scene         = parameters.create_scene();
    scene.active_stress = std::move(stress);
    return scene;
  }

  const Numerics mesh = {.degree = 4, .n_cells = 8, .tolerance = 1e-7, .initial_step = 1e-3, .integrator = "radau 5"};
} // namespace

TEST(Failures, HaveNames)
{
  const auto name_of = [](const auto &error) { return failure_of(std::make_exception_ptr(error)).reason; };
  EXPECT_EQ(name_of(std::bad_alloc()), "out_of_memory");
  EXPECT_EQ(name_of(PetscFailure(PETSC_ERR_MEM, "no memory", true)), "out_of_memory");
  EXPECT_EQ(name_of(PetscFailure(PETSC_ERR_ARG_OUTOFRANGE, "out of range", false)), "petsc_error");
  EXPECT_EQ(name_of(NonfiniteStress("nan")), "nonfinite");
  EXPECT_EQ(name_of(std::logic_error("a slip")), "exception");
  EXPECT_EQ(name_of(42), "exception");
  EXPECT_THROW(name_of(InputError("wrong")), InputError);
  EXPECT_THROW(name_of(FileError("disk full")), FileError);
  EXPECT_THROW(name_of(std::filesystem::filesystem_error("disk full", std::error_code())), FileError);
}

/// On both engines; what was computed until then is there.
TEST(Failures, EndARunInOrder)
{
  for (const std::string engine : {"automatic", "petsc"})
    for (const bool memory : {true, false})
    {
      const Parameters parameters = test::parameters_with({{"Time/Engine", engine}});
      const Scene scene           = scene_with(parameters,
                                     std::make_unique<Throwing>(
                                       [memory]() {
                                         if (memory)
                                           throw std::bad_alloc();
                                         throw std::runtime_error("the valve is shut");
                                       },
                                       0.5));
      Simulation simulation(MPI_COMM_SELF, scene, parameters.time, mesh);
      for (int i = 0; i < 2; ++i) // the object stays usable
      {
        const SimulationResult result = simulation.run({}, {.energy_balance = true});
        EXPECT_EQ(result.time.status, Status::failed) << engine;
        EXPECT_EQ(result.time.reason, memory ? "out_of_memory" : "exception");
        EXPECT_NE(result.time.message.find(memory ? "out of memory" : "the valve is shut"), std::string::npos);
        EXPECT_GT(result.time.steps, 3u);
        EXPECT_GT(result.time.time, 0.2);
        EXPECT_LT(result.time.time, 0.5);
        EXPECT_NE(result.displacement, 0.);
        EXPECT_GT(result.energy_balance->dissipation, 0.);
      }
    }
}

/// The second run, which measures the error, and a finer try may fail: the answer of the first one stays.
TEST(Failures, OfTheSecondRunLeaveTheAnswer)
{
  const Parameters parameters = test::parameters_with({{"Accuracy", "1e-6"}});
  const Scene scene           = scene_with(parameters,
                                 std::make_unique<Throwing>([]() { throw std::bad_alloc(); },
                                                            HUGE_VAL,
                                                            /*max_points=*/44));
  NumericsChoice choice;
  choice.numerics     = mesh;
  choice.wanted_error = 1e-9;
  const auto simulate = [&](const NumericsChoice &chosen) {
    return Simulation(MPI_COMM_SELF, scene, parameters.time, chosen.numerics).run({}, {.energy_balance = true});
  };
  const SimulationResult first = simulate(choice);
  const Answer answer =
    run_to_accuracy({parameters, scene}, choice, simulate, {.energy_balance = true}, /*writes=*/false);
  EXPECT_EQ(answer.result.displacement, first.displacement);
  EXPECT_EQ(answer.result.time.steps, first.time.steps);
  EXPECT_EQ(answer.result.time.status, Status::failed);
  EXPECT_EQ(answer.result.time.reason, "accuracy_not_met");
  EXPECT_NE(answer.result.time.message.find("out of memory"), std::string::npos);
}

/// The samples of a gait lie so densely that each change of mesh comes near one; a step that no observer sees must not
/// pass it, or the integrator would be asked for a state of the step before (PETSc's error 63).
TEST(Failures, MeshesThatChangeLoseNoSample)
{
  const Parameters parameters = test::parameters_with(
    test::with(test::wave(17., 0.37, 1., 2e4),
               "Discretization/Mesh = adaptive; Discretization/Mesh tolerance = 1e-5; tolerance = 1e-5; "
               "Time/Maximum number of steps = 3000"));
  const Scene scene       = parameters.create_scene();
  Numerics numerics       = {.degree = 4, .n_cells = 8, .tolerance = 1e-5, .initial_step = 1e-2};
  numerics.mesh.tolerance = 1e-5;
  Simulation simulation(MPI_COMM_SELF, scene, parameters.time, numerics);
  const auto result = simulation.run({}, {.energy_balance = true, .cycles = CycleWish{1., 1e-9}});
  EXPECT_EQ(result.time.reason, "step_limit") << result.time.message;
  EXPECT_GT(result.process.mesh.changes, 10u);
}
