// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/optimize/gait_problem.h>

#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace crawler
{
  /// Identifier of a start of a case.
  struct StartName
  {
    unsigned long number_of_case = 0, start = 0;
    unsigned long neighbour = 0; ///< number of the case with whose best gait it begins, from 1 on; 0: none

    bool
    operator==(const StartName &) const = default;
  };

  /// Result of one start of the optimiser.
  struct StartResult : StartName
  {
    GaitRecord best = {};
    std::vector<GaitLimit> limits;
    bool has_converged = false, was_interrupted = false;
    std::string message; ///< reason, if it has not converged
    unsigned int iterations = 0;
    double admissible       = 0.; ///< admissible violation of a limit, relative to it
    double seconds          = 0.;
    std::vector<GaitRecord> records; ///< all evaluations

    /// Returns true if there is a gait that keeps to the limits.
    bool
    is_admissible() const
    {
      return best.problem.empty() && best.violation <= admissible;
    }

    void
    exchange(Archive &archive)
    {
      archive(number_of_case, start, neighbour, best, limits, has_converged, was_interrupted, message);
      archive(iterations, admissible, seconds, records);
    }
  };

  /// Result of a start that makes no gait because of this @p problem.
  StartResult
  without_gait(const StartName &start, const std::vector<double> &x, const std::string &problem);

  /// Makes the level on which gaits are computed: simulations, or the kinematic level if Model says so. Throws
  /// InputError.
  std::unique_ptr<GaitModel>
  make_gait_model(
    SceneFamily &family, const std::vector<double> &start, const std::function<bool()> &stops = []() { return false; });

  /// Progress of a search.
  struct SearchState
  {
    std::size_t evaluations = 0;
    double best             = NAN; ///< best objective so far
  };

  /**
   * Searches for the best gait from the values @p x, which are those of @p start. Where the grid of the kinematic level
   * was too coarse for the result, and where the strain exceeds its limits between the places at which it is limited,
   * the search goes on from there. An interrupted search returns the best so far. Throws InputError.
   */
  StartResult
  search(SceneFamily &family,
         const StartName &start,
         const std::vector<double> &x,
         SearchState &state,
         const std::function<bool()> &stops);
} // namespace crawler
