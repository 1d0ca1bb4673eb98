// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Derivatives of the displacement by the adjoint, against differences of runs.
#include "../support/run_text.h"
#include "../support/test.h"

#include <crawler/adjoint/run_gradient.h>
#include <crawler/output/kymograph_writer.h>
#include <crawler/studies/core/compute.h>

using namespace crawler;
using test::with;

namespace
{
  Numerics
  numerics_for(const Scene &scene,
               const char *integrator,
               const unsigned int n_cells,
               const double tolerance,
               const Grading &grading = {})
  {
    return {.degree       = 6,
            .n_cells      = n_cells,
            .tolerance    = tolerance * scene.body.length,
            .initial_step = (grading.levels > 0 ? 1e-8 : 1e-3) * scene.end_time,
            .integrator   = integrator,
            .grading      = grading};
  }

  Scene
  scene_of(const test::Settings &settings, const std::string &entry, const double value)
  {
    test::Settings changed = settings;
    changed.emplace_back(entry, test::text(value));
    return test::parameters_with(changed).create_scene();
  }

  /// Scenes whose entry is so many steps from the value.
  std::vector<Scene>
  scenes_near(const test::Settings &settings,
              const std::string &entry,
              const double value,
              const double step,
              const std::vector<int> &places = {-2, -1, 1, 2})
  {
    std::vector<Scene> scenes;
    for (const int i : places)
      scenes.push_back(scene_of(settings, entry, value + i * step));
    return scenes;
  }

  double
  fourth_order(const double a, const double b, const double c, const double d, const double step)
  {
    return (8. * (c - b) - (d - a)) / (12. * step);
  }

  /// Of a run, [quantity].
  std::array<double, all_quantities.size()>
  numbers_of(const Scene &scene, const TimeParameters &time, const Numerics &numerics)
  {
    const SimulationResult result =
      Simulation(MPI_COMM_SELF, scene, time, numerics).run({}, {.energy_balance = true, .gait = GaitWish::declared});
    const EnergyBalance &works = *result.energy_balance;
    const Gait stride          = result.gait.value_or(Gait());
    return {{result.displacement,
             works.stress_work,
             works.dissipation,
             works.positive_work,
             works.paper_energy(),
             stride.displacement,
             result.gait ? stride.speed() : 0.}};
  }

  /// Both derivatives by an entry, of all quantities.
  struct Both
  {
    Derivatives adjoint;
    std::array<double, all_quantities.size()> differences, numbers;
  };

  /// How exact the runs are, and by how much of its value the entry is changed. Stresses with jumps need a graded mesh;
  /// to 1e-4, two neighbours do for them.
  struct Precision
  {
    Grading grading;
    double tolerance = 1e-12;
    double step      = 1e-3;
  };

  Both
  derivatives(const test::Settings &settings, const std::string &entry, const double value, const Precision &precision)
  {
    const bool jumps          = precision.grading.levels > 0;
    const Scene scene         = scene_of(settings, entry, value);
    const TimeParameters time = test::parameters_with(settings).time;
    const double step         = precision.step * std::abs(value);
    const auto numerics       = [&](const Scene &of) {
      return numerics_for(of, "radau 9", 10, precision.tolerance, precision.grading);
    };
    const std::vector<Scene> near = scenes_near(settings, entry, value, step);
    std::array<double, all_quantities.size()> numbers[4];
    for (const std::size_t i : jumps ? std::vector<std::size_t>{1, 2} : std::vector<std::size_t>{0, 1, 2, 3})
      numbers[i] = numbers_of(near[i], time, numerics(near[i]));
    EXPECT_TRUE(RecordedRun::is_possible(scene, time, numerics(scene)));
    const RecordedRun run(scene, time, numerics(scene), {});
    const Variation variation = {near, step};
    EXPECT_TRUE(have_similar_breaks(scene, near.front())) << entry;
    Both both = {gradient_of(run, {&variation, 1}, all_quantities).quantities.front(), {}, numbers[1]};
    for (std::size_t i = 0; i < all_quantities.size(); ++i)
      both.differences[i] = jumps ? (numbers[2][i] - numbers[1][i]) / (2. * step)
                                  : fourth_order(numbers[0][i], numbers[1][i], numbers[2][i], numbers[3][i], step);
    return both;
  }

  /// The derivatives of displacements to @p tolerance, relative to themselves; those of works, where they are known, to
  /// @p of_works. Returns how many others than that of the displacement are known.
  unsigned int
  expect_same(const test::Settings &settings,
              const std::string &entry,
              const double value,
              const double tolerance,
              const double of_works,
              const Precision &precision = {})
  {
    const Both both       = derivatives(settings, entry, value, precision);
    unsigned int n_others = 0;
    EXPECT_NEAR(both.adjoint[0].value(), both.differences[0], tolerance * std::abs(both.differences[0])) << entry;
    for (std::size_t i = 1; i < all_quantities.size(); ++i)
    {
      // The quadrature of the positive part is no smooth function.
      const double kinks = all_quantities[i] == Quantity::positive_work ? 1e-2 : 1e-9;
      n_others += both.adjoint[i].has_value();
      if (both.adjoint[i])
      {
        EXPECT_NEAR(*both.adjoint[i],
                    both.differences[i],
                    (is_work(all_quantities[i]) ? of_works : 10. * tolerance) * std::abs(both.differences[i]) +
                      kinks * std::abs(both.numbers[i] / value))
          << entry << ", quantity " << i;
      }
    }
    return n_others;
  }

  /// Of the displacement.
  std::optional<double>
  derivative(const RecordedRun &run, const Variation &variation)
  {
    return gradient_of(run, {&variation, 1}, {{Quantity::displacement}}).quantities.front().front();
  }

  const test::Settings wave = test::set("c = 1.3; chi = 0.3");
} // namespace

TEST(RunGradient, OfPlainBodies)
{
  for (const char *p : {"4", "2", "0.5", "-1"}) // a = -3, -1, 0.5, 2
  {
    const test::Settings scene = with(wave, {{"Body/Anchoring exponent", p}});
    for (const auto &[entry, value] : {std::pair("Body/Elastic modulus", 1.2),
                                       {"Body/Friction coefficient", 0.7},
                                       {"Body/Length", 1.1},
                                       {"Active stress/Optimal wave/Wave speed", 1.3},
                                       {"Active stress/Optimal wave/Perturbation parameter", 0.3},
                                       {"Time/End time", 0.9}})
      EXPECT_EQ(expect_same(scene, entry, value, 2e-8, 1e-6), 6u);
  }
  expect_same(wave, "Body/Anchoring exponent", 2.3, 2e-8, 1e-6);
}

TEST(RunGradient, OfGeneralBodies)
{
  const std::vector<test::Settings> scenes = {
    {{"Body/Elastic modulus profile", "1+0.5*sin(3*s)"}, {"Body/Friction profile", "1+0.3*s"}},
    {{"Ground/Profile", "1+0.2*sin(5*x)"}},
    {{"Ground/Backward ratio", "1.5"}, {"Ground/Switching velocity", "0.1"}}};
  for (const test::Settings &more : scenes)
    for (const auto &[entry, value] : {std::pair("Body/Elastic modulus", 1.2), {"Body/Friction coefficient", 0.7}})
      EXPECT_EQ(expect_same(with(wave, more), entry, value, 1e-7, 1e-6), 6u);
  expect_same(with(wave, {{"Ground/Switching velocity", "0.1"}}), "Ground/Backward ratio", 1.5, 1e-7, 1e-6);
}

/// Jumps of the active stress move with these entries, in time and in space.
TEST(RunGradient, OfJumpsThatMove)
{
  const test::Settings robot = test::set("T = 1.33; segments; Number of segments = 3; Amplitude = 0.3; Frequency = 1; "
                                         "Phase lag = 0.27; Duty cycle = 0.4; Gap = 0.05; Ramp duration = 0.6");
  const test::Settings trapezoids                   = with(robot, {{"Active stress/Segments/Rate limit", "2.5"}});
  using Entries                                     = std::vector<std::pair<const char *, double>>;
  const std::pair<test::Settings, Entries> scenes[] = {{robot,
                                                        {{"Active stress/Segments/Phase lag", 0.27},
                                                         {"Active stress/Segments/Duty cycle", 0.4},
                                                         {"Active stress/Segments/Gap", 0.05},
                                                         {"Body/Length", 1.}}},
                                                       {trapezoids,
                                                        {{"Active stress/Segments/Phase lag", 0.27},
                                                         {"Active stress/Segments/Frequency", 1.},
                                                         {"Active stress/Segments/Amplitude", 0.3},
                                                         {"Time/End time", 1.33}}}};
  for (const auto &[scene, entries] : scenes)
    for (const auto &[entry, value] : entries)
      EXPECT_EQ(expect_same(scene, entry, value, 2e-4, 2e-3, {{3, 0.25}, 1e-10}), 4u);
}

/// Jumps of different segments that come together, as those of robots with a lag of 1/N do.
TEST(RunGradient, OfJumpsThatComeTogether)
{
  const test::Settings robot = test::set("T = 1.33; segments; Number of segments = 4; Amplitude = 0.3; Frequency = 1; "
                                         "Phase lag = 0.25; Duty cycle = 0.5; Ramp duration = 0.6");
  const test::Settings trapezoids = with(robot, {{"Active stress/Segments/Rate limit", "2.5"}});
  for (const test::Settings &scene : {robot, trapezoids})
    for (const auto &[entry, value] : {std::pair("Active stress/Segments/Phase lag", 0.25),
                                       {"Active stress/Segments/Duty cycle", 0.5},
                                       {"Active stress/Segments/Frequency", 1.}})
      EXPECT_EQ(expect_same(scene, entry, value, 5e-4, 2e-3, {{3, 0.25}, 1e-12, 2.5e-4}),
                std::string(entry).ends_with("Frequency") ? 4u : 0u) // where they stay together
        << entry;
  // The last stride, beside the displacement.
  EXPECT_EQ(expect_same(with(robot, {{"Time/End time", "2.83"}}),
                        "Active stress/Segments/Phase lag",
                        0.25,
                        5e-4,
                        2e-3,
                        {{3, 0.25}, 1e-11, 2.5e-4}),
            2u);
}

/// A jump at the very end of the run comes in with a higher frequency, but does not go out with a lower one.
TEST(RunGradient, OfJumpsAtTheEndThereIsNone)
{
  const test::Settings robot =
    test::set("T = 1; segments; Number of segments = 4; Phase lag = 0.25; Ramp duration = 0.6");
  const Scene scene         = scene_of(robot, "Active stress/Segments/Frequency", 1.);
  const auto near           = scenes_near(robot, "Active stress/Segments/Frequency", 1., 1e-3);
  const Variation variation = {near, 1e-3};
  const RecordedRun run(
    scene, test::parameters_with(robot).time, numerics_for(scene, "radau 9", 8, 1e-8, {2, 0.25}), {});
  EXPECT_FALSE(derivative(run, variation));
}

/// An entry at a limit may vary to one side only.
TEST(RunGradient, ToOneSide)
{
  const Scene scene         = test::parameters_with(wave).create_scene();
  const TimeParameters time = test::parameters_with(wave).time;
  const double step         = 1e-3;
  const auto scenes         = scenes_near(wave, "Body/Elastic modulus", 1., step, {-2, -1, 1, 2, 3, 4}),
             downwards      = scenes_near(wave, "Body/Elastic modulus", 1., step, {-1, -2, -3, -4});
  const std::span all(scenes);
  const Variation variations[] = {{all.first(4), step}, {all.subspan(2), step, true}, {downwards, -step, true}};
  const RecordedRun run(scene, time, numerics_for(scene, "radau 9", 6, 1e-8), {});
  const auto derivatives = gradient_of(run, variations, all_quantities).quantities;
  for (const std::size_t one_sided : {1, 2})
    for (std::size_t i = 0; i < all_quantities.size(); ++i)
      EXPECT_NEAR(*derivatives[one_sided][i],
                  *derivatives[0][i],
                  (all_quantities[i] == Quantity::positive_work ? 1e-3 : 1e-7) * std::abs(*derivatives[0][i]))
        << i;
}

/// Exact for the steps and the mesh at hand: coarse ones of radau 5 have the gradient of their own displacement, which
/// accurate differences miss by as much as the displacement is off.
TEST(RunGradient, ConvergesAsTheDisplacementDoes)
{
  const Scene scene          = test::parameters_with(wave).create_scene();
  const TimeParameters time  = test::parameters_with(wave).time;
  const double step          = 1e-3;
  const auto near            = scenes_near(wave, "Body/Elastic modulus", 1., step);
  const Variation variation  = {near, step};
  const auto derivative_with = [&](const char *integrator, const unsigned int n_cells, const double tolerance) {
    const RecordedRun run(scene, time, numerics_for(scene, integrator, n_cells, tolerance), {});
    return derivative(run, variation).value();
  };
  const double exact = derivative_with("radau 9", 12, 1e-13);
  EXPECT_NEAR(derivative_with("radau 9", 4, 1e-5), exact, 2e-4 * std::abs(exact));
  EXPECT_NEAR(derivative_with("radau 5", 8, 1e-7), exact, 1e-5 * std::abs(exact));
  EXPECT_NEAR(derivative_with("radau 9", 8, 1e-8), exact, 2e-7 * std::abs(exact));
}

/// The whole body stiffer is each place stiffer.
TEST(RunGradient, LocalSensitivitiesAddUp)
{
  const TimeParameters time = test::parameters_with(wave).time;
  const double step         = 1e-3;
  // In these the stress is a formula, so it does not change with the body.
  const test::Settings fixed   = test::set("expression; Active stress = 0.2*sin(2*pi*(s+t))*sin(2*pi*t)");
  const Scene own              = test::parameters_with(fixed).create_scene();
  const auto k                 = scenes_near(fixed, "Body/Elastic modulus", 1., step),
             gamma             = scenes_near(fixed, "Body/Friction coefficient", 1., step);
  const Variation variations[] = {{k, step}, {gamma, step}};
  const Numerics numerics      = numerics_for(own, "radau 9", 8, 1e-10);
  const RecordedRun run(own, time, numerics, {});
  const RunGradient gradient = gradient_of(run, variations, {{Quantity::displacement}});
  const LaneTables tables({6, 8, 5});
  double by_k = 0., by_gamma = 0.;
  for (std::size_t p = 0; p < tables.points.size(); ++p)
  {
    const double ds = tables.setup.sizes[p / 7] * tables.setup.element.weights[p % 7];
    by_k += ds * gradient.local.elastic_modulus[p];
    by_gamma += ds * gradient.local.friction[p];
  }
  EXPECT_NEAR(by_k, *gradient.quantities[0][0], 1e-9 * std::abs(*gradient.quantities[0][0]));
  EXPECT_NEAR(by_gamma, *gradient.quantities[1][0], 1e-9 * std::abs(*gradient.quantities[1][0]));
}

/// The stretch at a place and a time, between stages and right behind the start of a step, too.
TEST(RunGradient, OfStretches)
{
  const test::Settings settings =
    test::set("expression; Active stress = A*sin(2*pi*(s+t))*sin(2*pi*t); Constants = A=0.2");
  const std::string entry = "Active stress/Expression/Constants[A]";
  const double value = 0.2, step = 2e-4;
  const Scene scene         = scene_of(settings, entry, value);
  const TimeParameters time = test::parameters_with(settings).time;
  const Numerics numerics   = numerics_for(scene, "radau 5", 6, 1e-7);
  const RecordedRun run(scene, time, numerics, {});
  std::vector<StretchPlace> places;
  std::vector<double> points, times;
  for (const double t : {run.steps.times[5] + 1e-3 * run.steps.sizes[6], run.steps.times[9], 0.5123, 0.77, 1.})
  {
    places.push_back({0.31, t, 1.});
    times.push_back(t);
  }
  const auto near = scenes_near(settings, entry, value, step);
  std::vector<std::vector<double>> seen;
  for (const Scene &one : near)
  {
    const auto kymograph = std::make_shared<Kymograph>(std::vector<double>{0.31});
    Simulation(MPI_COMM_SELF, one, time, numerics_for(one, "radau 9", 10, 1e-12))
      .run(PictureTimes({}, times, 1.), {}, {kymograph});
    seen.push_back(kymograph->rows().stretch);
    ASSERT_EQ(seen.back().size(), times.size());
  }
  const Variation variation  = {near, step};
  const RunGradient gradient = gradient_of(run, {&variation, 1}, {}, places);
  for (std::size_t i = 0; i < places.size(); ++i)
  {
    const double exact = fourth_order(seen[0][i], seen[1][i], seen[2][i], seen[3][i], step);
    EXPECT_NEAR(gradient.stretches[0][i].value(), exact, 2e-6 * std::abs(exact)) << times[i];
  }
}
