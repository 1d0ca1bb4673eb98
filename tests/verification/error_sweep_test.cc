// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Errors by the adjoint against true ones.
#include "../support/random.h"
#include "../support/run_text.h"
#include "../support/test.h"

#include <crawler/accuracy/choose_numerics.h>
#include <crawler/accuracy/run_to_accuracy.h>
#include <crawler/adjoint/error_sweep.h>
#include <crawler/studies/core/parameters.h>

using namespace crawler;

namespace
{
  Numerics
  numerics_for(const Scene &scene,
               const char *integrator,
               const unsigned int degree,
               const unsigned int n_cells,
               const double tolerance)
  {
    return {.degree       = degree,
            .n_cells      = n_cells,
            .tolerance    = tolerance * scene.body.length,
            .initial_step = 1e-2 * scene.end_time,
            .integrator   = integrator};
  }

  double
  displacement(const Scene &scene, const TimeParameters &time, const Numerics &numerics)
  {
    return Simulation(MPI_COMM_SELF, scene, time, numerics).run({}, {}).displacement;
  }

  test::Settings
  wave_of(const char *p, const char *k, const char *chi, const char *T = "1")
  {
    return test::set("c = 1; p = {}; k = {}; chi = {}; T = {}", p, k, chi, T);
  }
} // namespace

TEST(ErrorSweep, TellsSpaceFromTime)
{
  const Parameters parameters = test::parameters_with(wave_of("2", "1", "0.4"));
  const Scene scene           = parameters.create_scene();
  const double exact          = displacement(scene, parameters.time, numerics_for(scene, "radau 9", 8, 16, 1e-13));
  const RecordedRun in_space(scene, parameters.time, numerics_for(scene, "radau 9", 4, 6, 1e-11), {});
  const auto space = sweep_errors(in_space);
  ASSERT_TRUE(space && space->is_good());
  EXPECT_NEAR(space->space / (exact - in_space.displacement), 1., 0.2);
  EXPECT_LT(std::abs(space->time), 1e-3 * std::abs(space->space));
  const RecordedRun in_time(scene, parameters.time, numerics_for(scene, "radau 5", 8, 12, 1e-4), {});
  const auto time = sweep_errors(in_time);
  ASSERT_TRUE(time && time->is_good());
  EXPECT_NEAR(time->time / (exact - in_time.displacement), 1., 0.05);
  EXPECT_LT(std::abs(time->space), 1e-3 * std::abs(time->time));
}

/// Of many scenes and settings: the corrected displacement is within its bound, and two digits better.
TEST(ErrorSweep, CorrectedDisplacementsAreCovered)
{
  unsigned int n = 0, covered = 0;
  std::vector<double> effectivities, gains, ratios;
  for (const auto &settings : {wave_of("2", "1", "0.4"),
                               wave_of("2", "100", "0.3"),
                               wave_of("4", "1", "0.3"),
                               wave_of("-1", "1", "0.3"),
                               wave_of("2", "1", "0.3", "0.7"),
                               wave_of("2.5", "0.1", "0.2")})
  {
    const Parameters parameters = test::parameters_with(settings);
    const Scene scene           = parameters.create_scene();
    const double exact          = displacement(scene, parameters.time, numerics_for(scene, "radau 9", 8, 20, 1e-13));
    for (const unsigned int degree : {4u, 6u})
      for (const unsigned int n_cells : {4u, 6u, 9u})
        for (const auto &[integrator, tolerance] : {std::pair("radau 5", 1e-3),
                                                    {"radau 5", 1e-5},
                                                    {"radau 5", 1e-7},
                                                    {"radau 9", 1e-3},
                                                    {"radau 9", 1e-5},
                                                    {"radau 9", 1e-7}})
        {
          const RecordedRun run(
            scene, parameters.time, numerics_for(scene, integrator, degree, n_cells, tolerance), {});
          const auto errors = sweep_errors(run);
          if (!errors || !errors->is_good())
            continue;
          const double before = std::abs(exact - run.displacement),
                       after  = std::abs(exact - run.displacement - errors->time - errors->space);
          if (before < 1e-12)
            continue;
          ++n;
          const double bound = std::max(errors->bound_of_corrected(), 2e-13);
          covered += after <= bound;
          effectivities.push_back((errors->time + errors->space) / (exact - run.displacement));
          gains.push_back(before / after);
          ratios.push_back(bound / std::max(after, 1e-15));
        }
  }
  using test::quantile;
  std::cout << n << " runs, " << covered << " covered; effectivity " << quantile(effectivities, 0.05) << " "
            << quantile(effectivities, 0.5) << " " << quantile(effectivities, 0.95) << "; gain "
            << quantile(gains, 0.05) << " " << quantile(gains, 0.5) << "; bound/error " << quantile(ratios, 0.5)
            << '\n';
  EXPECT_GE(n, 150u);
  EXPECT_GE(covered, n - n / 100);
  EXPECT_NEAR(quantile(effectivities, 0.5), 1., 0.03);
  EXPECT_GE(quantile(gains, 0.5), 50.);
}

/// A try whose bound by a finer run meets Accuracy, but whose error by the adjoint does not, is made again, finer. One
/// whose sweep is stopped has no error, and is no answer.
TEST(ErrorSweep, JudgesTries)
{
  const Parameters parameters = test::parameters_with(
    test::set("L = 8.0996; k = 0.140817; gamma = 0.719439; p = 2; T = 1.9506; Accuracy = 1e-4; travelling wave; "
              "Amplitude = 0.098572; Wave number = 0.5; Frequency = 0.205065"));
  const Scene scene    = parameters.create_scene();
  unsigned int n_steps = 0, n_most = std::numeric_limits<unsigned int>::max();
  const auto keep_going = [&]() { return ++n_steps <= n_most; };
  const Problem problem{parameters, scene, keep_going};
  std::vector<unsigned int> begins; ///< of tries
  const auto simulate = [&](const NumericsChoice &choice) {
    begins.push_back(n_steps);
    return Simulation(MPI_COMM_SELF, scene, parameters.time, choice.numerics).run({}, {}, {}, keep_going);
  };
  const auto choice = choose_numerics(problem);
  const auto answer = [&]() { return run_to_accuracy(problem, *choice, simulate, {}, /*writes=*/true).result; };
  const SimulationResult result = answer();
  ASSERT_EQ(result.time.status, Status::finished) << result.time.message;
  EXPECT_EQ(result.process.refinements, 1u);
  EXPECT_NEAR(result.displacement, 9.340023374e-4, result.error->total); // at 1e-8
  ASSERT_TRUE(result.corrected);
  EXPECT_NEAR(result.corrected->value, 9.340023374e-4, result.corrected->error);
  ASSERT_EQ(begins.size(), 2u);
  n_most                         = begins[1] - 3; // near the end of the sweep
  n_steps                        = begins[0];
  const SimulationResult stopped = answer();
  ASSERT_TRUE(stopped.error);
  EXPECT_TRUE(std::isnan(stopped.error->total));
}
