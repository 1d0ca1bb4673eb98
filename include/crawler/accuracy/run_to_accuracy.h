// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>

#include <functional>

namespace crawler
{
  /**
   * Runs until the wanted error is met: repeats @p simulate with @p choice and estimates the error of the
   * displacement if `Error estimate` is set, and as long as that is more than wanted, tries again with more cells and a
   * smaller tolerance, at most max_refinements times (collective). A final error that is too large or unknown is a
   * failure, `accuracy_not_met`: with all results and the error that was reached. If the user chose the numerics, their
   * error is reported and that is all. A family of meshes has its own way (mesh_family.h), with @p options; if it does
   * not meet Accuracy the position form may. Only the last run is by @p simulate then, if that @p writes. If it
   * @p writes the adjoint judges tries, too.
   */
  Answer
  run_to_accuracy(const Problem &problem,
                  const NumericsChoice &choice,
                  const std::function<SimulationResult(const NumericsChoice &)> &simulate,
                  const RecordOptions &options,
                  bool writes);

  /// Answer on one rank without files, with numerics chosen for it.
  Answer
  answer_in_memory(const Problem &problem, const RecordOptions &options);
} // namespace crawler
