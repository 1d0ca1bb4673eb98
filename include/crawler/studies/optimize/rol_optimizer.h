// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/gait_problem.h>

#include <string>
#include <vector>

namespace crawler
{
  /// End of an optimisation.
  struct OptimizerEnd
  {
    std::vector<double> y;
    bool has_converged;
    std::string message;             ///< reason in words, if it has not converged
    unsigned int iterations;         ///< iterations of the outer loop
    std::vector<double> multipliers; ///< multipliers of c, positive where an upper bound holds
  };

  /**
   * Minimises the problem from @p y and a guess of the multipliers (one for each limit, or none). Minima of augmented
   * Lagrangians with bounds on y are found by the trust-region method of Lin and More in Trilinos' ROL. The Hessians of
   * objective and limited works are symmetric rank-one updates of their gradients (Nocedal and Wright, Numerical
   * Optimization, section 6.2); the limits at many places are taken as linear. The augmented Lagrangian of ROL itself
   * gives each limit a slack variable: with the 1024 to 2048 places where the strain of optimize_harmonics.prm is
   * limited it takes twice the evaluations for two harmonics, and has not converged after 20 000 for eight, instead of
   * 1536. Throws GaitModel::Interrupted.
   */
  OptimizerEnd
  minimise(GaitProblem &problem,
           const std::vector<double> &y,
           std::vector<double> multipliers,
           double tolerance,
           unsigned int max_iterations);
} // namespace crawler
