// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>

namespace crawler
{
  /// A run with its error, and how it was found.
  struct Answer
  {
    SimulationResult result; ///< with its error, if that was asked for and is known
    NumericsChoice choice;   ///< what was used in the end
    unsigned int refinements = 0;
    double estimate_seconds  = 0.; ///< that the errors took
  };

  /// A body that several runs say has inverted at that time has not done so before the last state that is shown: what
  /// the time is later for that adds to its error. The message says when and where.
  void
  end_before_inversion(SimulationResult &result);

  constexpr unsigned int most_refinements = 3;

  /// The reason of a run whose displacement is known, but not as accurately as wanted.
  constexpr const char *accuracy_not_met = "accuracy_not_met";
} // namespace crawler
