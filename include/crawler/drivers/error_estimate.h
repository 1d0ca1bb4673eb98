// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/displacement_error.h>
#include <crawler/drivers/numerics_choice.h>

#include <functional>

namespace crawler
{
  /// How far off the displacement of a run may be.
  struct ErrorEstimate
  {
    DisplacementError error;
    double seconds = 0.; ///< that the estimate took
  };

  /**
   * The error of the displacement of @p result, which a Simulation with @p choice gave (collective). A second, finer
   * run tells it (doc/numerics.md, "Error bars"): with x the difference of both displacements and w the error that the
   * choice promises,
   *
   *   total = 1.1 x + 0.2 w   (without a promise 2 x), and at least the error of round-off.
   *
   * It is split into space and time as the rule that chose the numerics expects it. Where the stretch collapses the
   * choice has measured the error, and no second run is made. Nothing is known of a result that is not finished, or
   * if the finer run did not finish or was stopped by @p keep_going.
   */
  ErrorEstimate
  estimate_error(MPI_Comm communicator,
                 const Scene &scene,
                 const TimeParameters &time,
                 const NumericsChoice &choice,
                 const SimulationResult &result,
                 const std::function<bool()> &keep_going = {});

  /// What is tried if an error is larger than promised: more cells, a smaller tolerance.
  NumericsChoice
  refined(const NumericsChoice &choice);
} // namespace crawler
