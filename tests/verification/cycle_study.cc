// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Is the bound of the cycle stop a bound? (doc/numerics.md, "Cycle stop")
//   cycle_study SCENES
// Random scenes with periodic stresses (a in [-3, 3], k in [0.003, 10], T in [4, 30], waves and formulas), each on the
// numerics of Accuracy 1e-8, once to the end and once for each of three wishes ended when a cycle repeats. Prints a row
// for each run that ended early. Exit status 1 if a difference of the displacement is larger than bound and error in
// time.
#include "../support/random.h"
#include "../support/run_text.h"

#include <crawler/base/mpi_session.h>

namespace
{
  using namespace crawler;

  test::Settings
  periodic_scene(const unsigned int number)
  {
    test::Random random(5000 + number);
    const double a = random.uniform(-3., 3.), k = random.log_uniform(0.003, 10.),
                 chi = random.uniform(0.03, std::abs(a) > 2. ? 0.25 : 0.4), T = random.uniform(4., 30.);
    const test::Settings settings = test::with(test::wave(a, chi, a > 0. ? -1. : 1., T, k), "Accuracy = 1e-8");
    if (number % 3 != 1)
      return settings;
    const double A = random.uniform(0.02, 0.3) * k, B = random.uniform(0., 0.3) * k, f = random.uniform(0.7, 2.);
    return test::with(settings,
                      "expression; Active stress = A*sin(2*pi*(s-f*t))*sin(pi*s)+B*sin(4*pi*f*t+s)*s*(1-s); "
                      "Constants = A={}, B={}, f={}",
                      A,
                      B,
                      f);
  }
} // namespace

int
main(int argc, char **argv)
{
  int one = 1;
  const crawler::MpiSession guard(one, argv);
  if (argc < 2)
  {
    fmt::print(stderr, "usage: cycle_study SCENES\n");
    return 2;
  }
  const auto n_scenes = static_cast<unsigned int>(std::stoul(argv[1]));
  unsigned int early = 0, wrong = 0;
  std::vector<double> ratios;
  for (unsigned int i = 0; i < n_scenes; ++i)
  {
    const Parameters parameters = test::parameters_with(periodic_scene(i));
    const Scene scene           = parameters.create_scene();
    const auto choice           = choose_numerics({parameters, scene});
    const auto period           = scene.active_stress->period();
    Simulation simulation(MPI_COMM_SELF, scene, parameters.time, choice->numerics);
    const SimulationResult full = simulation.run({}, {});
    if (full.time.status != Status::finished || !period)
      continue;
    const double in_time = 2. * choice->wanted_error;
    for (const double accuracy : {1e-2, 1e-4, 1e-6})
    {
      const SimulationResult result = simulation.run({}, {.cycles = CycleWish{*period, accuracy}});
      if (!result.cycles)
        continue;
      const double difference = std::abs(result.displacement - full.displacement), bound = result.cycles->bound;
      const bool good = difference <= bound + in_time;
      ++early;
      wrong += !good;
      if (difference > in_time)
        ratios.push_back(bound / difference);
      fmt::print("{:3} accuracy {:.0e} displacement {:11.4e} cycles {:3} + {:3} difference {:.2e} bound {:.2e}{}\n",
                 i,
                 accuracy,
                 full.displacement,
                 result.cycles->computed,
                 result.cycles->extrapolated,
                 difference,
                 bound,
                 good ? "" : "  <- ABOVE");
    }
  }
  fmt::print("{} runs ended early, {} differences above bound and error in time", early, wrong);
  fmt::print("; bound over difference, where it can be told ({}): {:.1f} to {:.0f}, median {:.1f}\n",
             ratios.size(),
             test::quantile(ratios, 0.),
             test::quantile(ratios, 1.),
             test::quantile(ratios, 0.5));
  return wrong == 0 && early > 0 ? 0 : 1;
}
