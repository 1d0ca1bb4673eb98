// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>

#include <span>

namespace crawler
{
  /**
   * Errors of the numbers of @p result from those of a @p finer run, measured as the displacement's is
   * (error_estimate.h): @p factor times the difference x of both, and @p part of the scale S of the number, which is
   * the exchanged work for works and energies, the largest strain for stretches, and the number itself for others:
   *
   *   error = factor x + part S.
   *
   * Numbers found by sampling N quadrature points along the body, where the sign of the power changes or the stretch is
   * extreme, converge more slowly; their error is 1.5 factor x + (part + 2/N^2) S (doc/numerics.md, "Error bounds").
   */
  NumberErrors
  number_errors(const SimulationResult &result, const SimulationResult &finer, double factor, double part);

  /// Errors of a result that is extrapolated from the last two of some @p meshes, each twice as fine as the one before:
  /// for works, say, the change by the extrapolation. Numbers that are not extrapolated, such as stretches, are those
  /// of the finest mesh; their errors are twice the change since the mesh before, or the change since the one before
  /// that if this is larger: peaks of steep fronts do not converge regularly.
  NumberErrors
  errors_of_extrapolation(const SimulationResult &extrapolated,
                          std::span<const SimulationResult *const> meshes,
                          double part);
} // namespace crawler
