// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

namespace crawler
{
  /**
   * The errors of the numbers of @p result from those of a @p finer run, measured as the displacement's is
   * (error_estimate.h): @p factor times the difference x of both, and @p part of the scale S of the number, which is
   * the exchanged work for works and energies, the largest strain for stretches, and the number itself for others:
   *
   *   error = factor x + part S.
   *
   * Numbers that are found by looking at N quadrature points along the body, where the sign of the power changes or the
   * stretch is extreme, converge more slowly; theirs is 1.5 factor x + (part + 2/N^2) S (doc/numerics.md, "Error
   * bounds").
   */
  NumberErrors
  number_errors(const SimulationResult &result, const SimulationResult &finer, double factor, double part);
} // namespace crawler
