// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The errors that the levels perturbation and kinematic estimate, against those that they have: the optimal waves of
// random_scenes.h, computed with the nonlinear model to 1e-6 of the displacement. Prints a table (CSV) and, at its end,
// how many of the true errors are within the estimates and the median of estimate/true.
//
//     build/tests/ladder_study [number of scenes]
#include "random_scenes.h"

#include <crawler/base/mpi_session.h>
#include <crawler/reduced_models/perturbation.h>
#include <crawler/run/reduced_model.h>

#include <cmath>
#include <iostream>

using namespace crawler;

int
main(int argc, char **argv)
{
  const unsigned int n = argc > 1 ? static_cast<unsigned int>(std::stoul(argv[1])) : 100;
  int one              = 1;
  const crawler::MpiSession guard(one, argv);
  std::cout << "scene,displacement,perturbation true,perturbation estimated,kinematic true,kinematic estimated,"
               "changes\n";
  unsigned int within[2] = {0, 0}, total = 0, unknown = 0, skipped = 0;
  std::vector<double> ratios[2];
  for (unsigned int number = 0; total + unknown < n; ++number)
  {
    const auto wave = test::random_scene(number);
    if (wave.kind != "wave")
      continue;
    const auto truth = test::true_displacement(wave.settings);
    if (!truth)
    {
      ++skipped;
      continue;
    }
    const Parameters parameters = test::parameters_with(wave.settings);
    const Scene scene           = parameters.create_scene();
    const ReducedScene levels(scene);
    const ModelErrors errors = levels.model_errors();
    std::cout << number << ',' << *truth << ',';
    if (!errors.known)
    {
      ++unknown;
      std::cout << ",,,,,\n";
      continue;
    }
    ++total;
    const double D            = *truth / levels.units.length; // these are in natural units
    const double series       = perturbation::displacement(*levels.wave, 1.);
    const double motion       = kinematic(levels.scene, *levels.strain, 1e-8).displacement;
    const double is[2]        = {std::abs(series - D), std::abs(motion - D)};
    const double estimated[2] = {errors.perturbation, errors.kinematic};
    for (unsigned int i = 0; i < 2; ++i)
    {
      within[i] += is[i] <= estimated[i] + 2e-6 * std::abs(D) + 1e-15; // the error of the truth itself
      ratios[i].push_back(estimated[i] / is[i]);
      std::cout << is[i] << ',' << estimated[i] << ',';
    }
    std::cout << errors.changes[0] << ' ' << errors.changes[1] << ' ' << errors.changes[2] << '\n';
  }
  for (unsigned int i = 0; i < 2; ++i)
    std::cout << (i == 0 ? "# perturbation: " : "# kinematic: ") << within[i] << " of " << total
              << " true errors within the estimate, median of estimate/true " << test::quantile(ratios[i], 0.5) << '\n';
  std::cout << "# " << unknown << " estimates unknown, " << skipped << " bodies inverted\n";
}
