// SPDX-License-Identifier: LGPL-2.1-or-later
//
// How many cells, graded how, do stresses that start or jump suddenly need? (doc/numerics.md, "Jumps and sudden
// starts")
//   jump_study [a k]
// Prints the relative error of the displacement over degree, cells, levels and ratio of the grading with very small
// steps.
#include "../support/lane_runs.h"
#include "../support/with_breaks.h"

#include <crawler/base/mpi_session.h>


namespace
{
  using namespace crawler;

  struct Case
  {
    std::string name, formula;
    std::vector<double> in_space, in_time;
  };

  /// A sudden start of the whole body, a wave that starts suddenly, and a robot of two segments that switch.
  std::vector<Case>
  cases(const double k)
  {
    const std::string A = test::text(0.3 * std::min(k, 1.));
    return {{"start", A + "*(1+s)", {}, {}},
            {"wave", A + "*cos(2*pi*(s+t))", {}, {}},
            {"robot",
             A + "*(s<0.4 ? (mod(2*t,1)<0.5 ? 1 : -1) : (mod(2*t+0.25,1)<0.5 ? 1 : -1))",
             {0.4},
             {0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875}}};
  }

  struct Measured
  {
    double displacement = 0.;
    unsigned int cells = 0, steps = 0;
  };

  Measured
  measure(const Case &c, const double a, const double k, const Numerics &numerics)
  {
    test::LaneRun run(test::expression(a, c.formula, 1., k), "radau 9", numerics);
    run.scene.active_stress =
      std::make_unique<test::WithBreaks>(std::move(run.scene.active_stress), c.in_space, c.in_time);
    // What the smallest cell needs to come to rest.
    const auto ends           = first_cell_ends(run.scene, numerics);
    const double h            = ends.empty() ? 1. / numerics.n_cells : ends[1];
    run.numerics.initial_step = std::min(1e-2, h * h / k / std::pow(numerics.degree, 4));
    const auto result         = test::run_alone(run, {.energy_balance = false}, single_engine());
    if (!result)
      return {std::nan(""), 0, 0};
    return {result->displacement, result->mesh.most_cells, result->time.steps};
  }
} // namespace

int
main(int argc, char **argv)
{
  int one = 1;
  const crawler::MpiSession guard(one, argv);
  const double a = argc > 1 ? std::stod(argv[1]) : -1., k = argc > 2 ? std::stod(argv[2]) : 1.;
  for (const Case &c : cases(k))
  {
    const Numerics finest = {.degree = 8, .n_cells = 24, .tolerance = 1e-12, .grading = {8, 0.25}};
    const Measured exact  = measure(c, a, k, finest);
    fmt::print("{}: a = {:g}, k = {:g}: D = {:.12g} with {} cells, {} steps\n",
               c.name,
               a,
               k,
               exact.displacement,
               exact.cells,
               exact.steps);
    for (const unsigned int degree : {6u, 8u})
      for (const double ratio : {0.15, 0.25, 0.4})
        for (const unsigned int n : {4u, 8u})
          for (const unsigned int levels : {0u, 2u, 4u, 6u, 8u})
          {
            Numerics numerics = finest;
            numerics.degree   = degree;
            numerics.n_cells  = n;
            numerics.grading  = {levels, ratio};
            const Measured m  = measure(c, a, k, numerics);
            fmt::print("  degree {} ratio {:4.2f} n {:2} levels {:2}: {:4} cells {:5} steps error {:.2e}\n",
                       degree,
                       ratio,
                       n,
                       levels,
                       m.cells,
                       m.steps,
                       std::abs(m.displacement / exact.displacement - 1.));
          }
  }
  return 0;
}
