// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation_result.h>
#include <crawler/scene/scene.h>

#include <span>
#include <vector>

namespace crawler
{
  /// Round-off of the displacement, as a part of the length of the body.
  inline constexpr double displacement_round_off = 1e-15;

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
  std::vector<double>
  number_errors(const SimulationResult &result, const SimulationResult &finer, double factor, double part);

  /// Errors of a result that is extrapolated from the last two of some @p meshes, each twice as fine as the one before:
  /// for works, say, the change by the extrapolation. Numbers that are not extrapolated, such as stretches, are those
  /// of the finest mesh; their errors are twice the change since the mesh before, or the change since the one before
  /// that if this is larger: peaks of steep fronts do not converge regularly.
  std::vector<double>
  errors_of_extrapolation(const SimulationResult &extrapolated,
                          std::span<const SimulationResult *const> meshes,
                          double part);

  /// Adds what the extrapolation of cycles leaves open, to the errors of a @p result with a displacement of this
  /// @p size: works have its relative error, or their own bound if that is larger; the stride is the last computed one,
  /// whose displacement may change by the bound of the displacement over the number of extrapolated cycles. A cost of
  /// transport that is not known at all then has no error.
  void
  add_errors_of_cycles(SimulationResult &result, double size);

  /// Extends the errors of efficiencies to those of their displacement and of the limit that the extreme stretches set,
  /// once these are known; runs differ in their energies as they do in the efficiencies. Errors of a stride's
  /// displacement and speed become at least round-off: where the centre stays, the error of the run.
  void
  extend_errors(const Scene &scene, SimulationResult &result);
} // namespace crawler
