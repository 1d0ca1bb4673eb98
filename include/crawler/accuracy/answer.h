// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/run/run_parameters.h>
#include <crawler/run/simulation.h>

namespace crawler
{
  /// Problem to answer: a scene with its parameters, which are the caller's. All runs of it ask whether they may go on;
  /// the ranks share their cells.
  struct Problem
  {
    const RunParameters &parameters;
    const Scene &scene;
    KeepGoing keep_going = {};
    MPI_Comm ranks       = MPI_COMM_SELF;
  };

  /// Run with its error and the numerics that were used.
  struct Answer
  {
    SimulationResult result; ///< result with its error, if that was requested and is known
    NumericsChoice choice;   ///< numerics of the final run
  };

  /// Moves the time of an inversion on which several runs agree to the last state that is shown, before which it has
  /// not happened; the delay is added to its error. The message says when and where.
  void
  end_before_inversion(SimulationResult &result);

  /// Reason of a run whose displacement is known, but not as accurately as wanted.
  constexpr const char *accuracy_not_met = "accuracy_not_met";

  /// Makes a result a failure, accuracy_not_met, if the error of its displacement is larger than @p wanted, or not
  /// known since @p unknown. Returns true if so.
  bool
  fails_accuracy(SimulationResult &result, double wanted, const std::string &unknown);
} // namespace crawler
