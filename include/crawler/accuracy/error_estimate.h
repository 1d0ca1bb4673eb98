// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>

namespace crawler
{
  /**
   * Sets the errors of @p result, which a Simulation with @p choice gave and which finished (collective). A second,
   * finer run gives that of the displacement (doc/numerics.md, "Error bounds"): with x the difference of both
   * displacements and w the wanted error, if a rule chose the numerics,
   *
   *   total = 1.5 x + w/5   (w/2 on adaptive meshes, 0.15 w on graded ones),
   *
   * and at least 1e-15 L, the error of round-off. Without a rule a third run with more cells only separates the
   * parts in space and time, and total is twice their sum.
   *
   * The rule that chose the numerics predicts the split into space and time. Where the stretch collapses the choice has
   * measured the error, and no second run is made. The error is unknown if the finer run did not finish or was not to
   * go on. Other numbers have errors by number_errors(), with the same factors and Accuracy as the wanted error, if
   * there was a second run.
   */
  void
  estimate_errors(const Problem &problem, const NumericsChoice &choice, SimulationResult &result);

  /// Numerics of the next try where the error of @p choice is too large: @p cells times the cells, @p tolerance times
  /// the time tolerance.
  NumericsChoice
  refined(const NumericsChoice &choice, const Scene &scene, double cells, double tolerance);

  /// Entries of section Time for the finer run that measures the errors of a run with this @p result; then its
  /// numerics.
  TimeParameters
  time_of_finer_run(const TimeParameters &run);
  Numerics
  numerics_of_finer_run(const NumericsChoice &choice,
                        const TimeParameters &time,
                        const Scene &scene,
                        const SimulationResult &result);

  /// Sets the errors of a finished @p result from the finer run; null if there was none since the choice knows.
  void
  set_errors(const Problem &problem,
             const NumericsChoice &choice,
             SimulationResult &result,
             const SimulationResult *finer,
             const SimulationResult *finer_mesh = nullptr);

  /**
   * Measures the error of a finished @p result, whose bound is known, once more by the adjoint (adjoint/error_sweep.h):
   * its parts in space and time, which were those that the rule of the numerics expects, and the corrected displacement
   * with its bound. A bound below the error found by the sweep is raised to it: then this returns true. Nothing is done
   * where there is no adjoint, cycles were extrapolated, ranks share the cells or friction depends on the direction,
   * and for runs of so many steps and cells that it would take long. If it is stopped the error is unknown.
   */
  bool
  sweep_error(const Problem &problem, const NumericsChoice &choice, SimulationResult &result);
} // namespace crawler
