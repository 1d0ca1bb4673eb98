// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/recorded_run.h>

#include <optional>
#include <vector>

namespace crawler
{
  /// Errors of the displacement of a run, by one backward sweep [length]: D + time + space is nearer to the truth.
  struct SweptErrors
  {
    double time, space;         ///< estimates, with their signs
    double time_sum, space_sum; ///< sums of the sizes over steps, and over cells
    double space_change;        ///< change by the last improvement of the part that the elements cannot represent
    std::vector<double> of_steps, of_cells;

    /// True if the estimate of the part in space settles, unlike on a coarse mesh that misses the motion of a soft
    /// body.
    bool
    is_good() const
    {
      return space_change <= 0.5 * space_sum;
    }

    /// Bound of the error of D + time + space.
    double
    bound_of_corrected() const;
  };

  /**
   * Computes the errors in time and space separately (doc/numerics.md, "Errors by the adjoint"): by the adjoint of the
   * method with two more stages about the polynomials of the steps, and in each cell two functions of higher degree
   * that vanish at its ends. Nothing if the adjoint does not converge, or if the stretch with these functions is nearly
   * lost.
   */
  std::optional<SweptErrors>
  sweep_errors(const RecordedRun &run);
} // namespace crawler
