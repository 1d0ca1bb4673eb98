// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Pictures come from the dense output of the integrator (doc/numerics.md, "Pictures").
#include "../support/stress.h"
#include "../support/test.h"

#include <crawler/output/field_sampler.h>

using namespace crawler;
using test::largest_difference;
using test::Settings;

namespace
{
  /// What an observer sees of one state.
  struct Seen
  {
    double time, computed_time, displacement, dissipation, smallest, residual;
    std::vector<double> stretch, velocity, active_stress;
    bool is_step_end;
    PictureKinds pictures;
  };

  Seen
  seen_in(const Snapshot &snapshot)
  {
    const Discretization &d = snapshot.assembler.discretization;
    std::vector<CellPlace> points;
    for (unsigned int i = 0; i <= 20; ++i)
    {
      const double place      = 0.05 * i * d.n_cells();
      const unsigned int cell = std::min(static_cast<unsigned int>(place), d.n_cells() - 1);
      points.push_back({cell, place - cell});
    }
    FieldSampler sampler([&](const Discretization &) { return points; });
    const Fields &fields = sampler.sample(snapshot);
    return {snapshot.step.time,
            snapshot.computed_time,
            snapshot.displacement,
            snapshot.energy_balance.dissipation,
            snapshot.stretch.min.value,
            snapshot.energy_balance.residual(),
            fields.stretch,
            fields.velocity,
            fields.active_stress,
            snapshot.is_step_end,
            snapshot.pictures};
  }

  struct Compared
  {
    SimulationResult result;
    NumericsChoice choice;
    PictureTimes times;
    std::vector<Seen> seen;

    std::vector<Seen>
    pictures() const
    {
      std::vector<Seen> some;
      std::copy_if(
        seen.begin(), seen.end(), std::back_inserter(some), [](const Seen &one) { return one.pictures.is_snapshot; });
      return some;
    }
  };

  /// As `crawler run` does it, but for the error bound.
  Compared
  run(const Settings &settings, const std::optional<Numerics> &numerics = {}, const bool has_pictures = true)
  {
    const Parameters parameters = test::parameters_with(settings);
    const Scene scene           = parameters.create_scene();
    Compared run;
    run.choice = *choose_numerics({parameters, scene});
    prepare_for_pictures(run.choice, parameters);
    if (numerics)
      run.choice.numerics = *numerics;
    if (has_pictures)
      run.times = picture_times(parameters.output, scene);
    const auto observers = watched_by([&](const Snapshot &snapshot) { run.seen.push_back(seen_in(snapshot)); });
    run.result           = Simulation(MPI_COMM_SELF, scene, parameters.time, run.choice.numerics)
                   .run(run.times, {.energy_balance = true}, observers);
    return run;
  }

  Settings
  robot(const double end_time)
  {
    return test::set("T = {}; segments; Gap = 0.1; Ramp duration = 0", end_time);
  }
} // namespace

/// Steps know nothing of pictures.
TEST(Pictures, ChangeNeitherStepsNorResults)
{
  for (const Settings &settings : {test::wave(-1., 0.4), test::wave(2., 0.2, 1., 3.), robot(1.)})
  {
    const Compared with = run(settings), without = run(settings, with.choice.numerics, /*has_pictures=*/false);
    EXPECT_EQ(with.result.displacement, without.result.displacement);
    EXPECT_EQ(with.result.time.steps, without.result.time.steps);
    EXPECT_EQ(with.result.energy_balance->dissipation, without.result.energy_balance->dissipation);
    EXPECT_GE(with.pictures().size(), 65u);
  }
}

/// Displacement, velocity and works at the demanded times against steps that are far shorter: the displacement is as
/// accurate as wanted at all times, and all errors fall with Accuracy.
TEST(Pictures, AreAsAccurateAsWanted)
{
  for (const Settings &scene :
       {test::wave(-1., 0.4),
        test::with(test::wave(2., 0.2, -1.), "L = 2; gamma = 0.3; T = 1.7; Output/Number of snapshots = 49"),
        test::with(test::wave(-1., 0.3, 1., 1., 100.), {{"Time/Engine", "petsc"}}),
        test::wave(-1., 0.3, 1., 1., 1e4),
        test::wave(-1., 0.3, 1., 1., 1e-2)})
  {
    double last = HUGE_VAL;
    for (const char *accuracy : {"1e-4", "1e-6", "1e-8"})
    {
      const Settings settings = test::with(scene, "Accuracy = {}", accuracy);
      const Compared coarse   = run(settings);
      Numerics fine           = coarse.choice.numerics;
      fine.tolerance          = 1e-4 * fine.tolerance;
      const Compared exact    = run(settings, fine);
      const auto some = coarse.pictures(), all = exact.pictures();
      std::vector<double> wanted;
      for (const PictureTimes::Time &time : coarse.times.all())
        if (time.kinds.is_snapshot)
          wanted.push_back(time.value);
      ASSERT_EQ(some.size(), wanted.size());
      ASSERT_EQ(all.size(), wanted.size());
      double u = 0., v = 0., largest_v = 0., dissipation = 0., smallest = 0., residual = 0.;
      for (std::size_t i = 0; i < all.size(); ++i)
      {
        EXPECT_EQ(some[i].time, wanted[i]); // exactly, in the user's units
        EXPECT_NEAR(some[i].computed_time, wanted[i] / wanted.back(), 1e-15);
        u           = std::max(u, std::abs(some[i].displacement - all[i].displacement));
        v           = std::max(v, largest_difference(some[i].velocity, all[i].velocity));
        largest_v   = std::max(largest_v, largest_difference(all[i].velocity, std::vector<double>(21, 0.)));
        dissipation = std::max(dissipation, std::abs(some[i].dissipation - all[i].dissipation));
        smallest    = std::max(smallest, std::abs(some[i].smallest - all[i].smallest));
        residual    = std::max(residual, some[i].residual);
      }
      const double A = std::stod(accuracy);
      EXPECT_LT(u, coarse.choice.wanted_error);
      EXPECT_LT(v, 200. * A * largest_v); // one order less
      EXPECT_LT(dissipation, 10. * A * exact.result.energy_balance->dissipation);
      EXPECT_LT(smallest, 20. * A);
      EXPECT_LT(u, last);
      last = u;
    }
  }
}

/// A row on each side of each jump of the active stress, with its two values and the same stretch.
TEST(Pictures, ShowBothSidesOfAJump)
{
  const Compared robots = run(robot(1.));
  unsigned int n        = 0;
  for (std::size_t i = 1; i < robots.seen.size(); ++i)
  {
    const Seen &before = robots.seen[i - 1], &after = robots.seen[i];
    if (!before.pictures.is_row || !after.pictures.is_row || after.time != before.time)
      continue;
    ++n;
    EXPECT_LT(largest_difference(before.stretch, after.stretch), 1e-12);
    EXPECT_NEAR(largest_difference(before.active_stress, after.active_stress), 0.3, 1e-12);
  }
  EXPECT_EQ(n, 7u); // one segment switches on when another switches off, every eighth of a stride
}

/// The body is seen until it inverts, however long the step in which it does.
TEST(Pictures, AreThereUntilTheBodyInverts)
{
  const Compared lost = run(test::with(test::wave(1., 0.9), "Output/Number of snapshots = 200"));
  ASSERT_EQ(lost.result.time.status, Status::inverted);
  ASSERT_TRUE(lost.result.inversion);
  const Seen last = lost.pictures().back(); // a copy: the pictures are a temporary
  EXPECT_LT(last.time, lost.result.inversion->t);
  EXPECT_GT(last.time, lost.result.inversion->t - 1. / 200. - 1e-12);
  EXPECT_GT(*std::min_element(last.stretch.begin(), last.stretch.end()), 0.);
}

/// What has no collocation polynomial ends its steps at snapshots.
TEST(Pictures, OfOtherIntegratorsAreEndsOfSteps)
{
  for (const Seen &one : run(test::with(test::wave(-1., 0.2), "integrator = bdf")).pictures())
    EXPECT_TRUE(one.is_step_end);
}

/// Long gaits have rows of the last strides only, short ones of the whole run; jumps are rows.
TEST(Pictures, TimesFollowTheStride)
{
  const auto times = [](const Settings &settings) {
    const Parameters parameters = test::parameters_with(settings);
    return picture_times(parameters.output, parameters.create_scene());
  };
  EXPECT_EQ(times(test::wave(-1., 0.1)).n_snapshots(), 64u);
  EXPECT_EQ(times(test::wave(-1., 0.1, 1., 5.)).n_snapshots(), 320u);
  const PictureTimes all = times(test::wave(-1., 0.1, 1., 100.));
  EXPECT_EQ(all.n_snapshots(), 640u);
  for (const PictureTimes::Time &time : all.all())
    EXPECT_TRUE(!time.kinds.is_row || time.value > 80.) << time.value;
  EXPECT_TRUE(times({{"Output/Number of snapshots", "0"}}).is_empty());
  for (std::size_t i = 1; i < all.all().size(); ++i)
    EXPECT_LT(all.all()[i - 1].value, all.all()[i].value);
}
