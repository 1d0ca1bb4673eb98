// SPDX-License-Identifier: LGPL-2.1-or-later
#include "../../support/run_text.h"
#include "../../support/test.h"

#include <crawler/run/step_limiter.h>

using namespace crawler;

namespace
{
  Scene
  formula(const std::string &text)
  {
    return test::parameters_with(test::set("expression; Active stress = {}", text)).create_scene();
  }
} // namespace

TEST(StressWatch, IsCalmWhereStepsAreFineEnough)
{
  const Scene scene = formula("0.3*sin(2*pi*(s+t))+0.1*s");
  StressWatch watch(*scene.active_stress, 0.03);
  for (unsigned int i = 0; i < 20; ++i)
    EXPECT_TRUE(watch.is_calm(0.3 * i, 0.3 * (i + 1)));
}

/// A step of some widths of an event is noticed by nearly all of the times that are looked at, one of a hundred widths
/// sooner or later, since the times are never the same.
TEST(StressWatch, SeesEvents)
{
  const Scene scene = formula("0.5*exp(-((t-0.5)/0.01)^2)");
  for (const auto &[half, least] : {std::pair{0.03, 95u}, {0.1, 30u}, {0.5, 4u}})
  {
    StressWatch watch(*scene.active_stress, 0.05);
    unsigned int n_seen = 0;
    for (unsigned int i = 0; i < 100; ++i)
      n_seen += !watch.is_calm(0.5 - half, 0.5 + half);
    EXPECT_GE(n_seen, least) << half;
  }
}

/// An event that nothing else can see: the generator does not say how fast it changes, and the samples miss it.
TEST(StressWatch, LetsAStepBeMadeAgain)
{
  const Scene quiet  = formula("0.1*sin(2*pi*(s+t))*tanh(5*t)"),
              active = formula("0.1*sin(2*pi*(s+t))*tanh(5*t)+0.3*sin(2*pi*s)*exp(-((t-0.5)/0.02)^2)");
  const auto run     = [](const Scene &scene, const double min_event) {
    const Numerics numerics = {
          .degree = 6, .n_cells = 8, .tolerance = 1e-2, .initial_step = 0.1, .min_event = min_event};
    TimeParameters time;
    time.integrator = "radau 5";
    return Simulation(MPI_COMM_WORLD, scene, time, numerics).run({}, {});
  };
  const double exact = test::run_with(test::set("Accuracy = 1e-8; expression; Active stress = "
                                                "0.1*sin(2*pi*(s+t))*tanh(5*t)+0.3*sin(2*pi*s)*exp(-((t-0.5)/0.02)^2)"))
                         .result.displacement;
  const auto without = run(active, 0.), with = run(active, 0.03);
  EXPECT_EQ(with.time.status, Status::finished);
  EXPECT_GT(with.time.steps, without.time.steps);
  EXPECT_GE(with.time.rejected_steps, 1u);
  EXPECT_LT(std::abs(with.displacement - exact), 0.05 * std::abs(exact));
  EXPECT_EQ(run(quiet, 0.03).time.steps, run(quiet, 0.).time.steps);
}
