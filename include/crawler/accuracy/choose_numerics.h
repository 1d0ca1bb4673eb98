// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/answer.h>

#include <optional>

namespace crawler
{
  /**
   * Turns Accuracy into degree, number of cells and time tolerance; entries that the user has set are respected
   * (collective). The rule, with its constants, is explained in doc/numerics.md ("Accuracy"): pilot runs on a coarse
   * mesh with a loose tolerance measure the size of the displacement and how fast the Legendre modes of the stretch
   * decay; the mesh is refined until the predicted error of the displacement in space is below Accuracy, and the
   * tolerance is chosen such that the error in time is. Nothing is returned if a pilot run was not to go on.
   */
  std::optional<NumericsChoice>
  choose_numerics(const Problem &problem);

  /// Adjusts the tolerance for pictures: at times within steps they are less accurate than the ends of the steps of
  /// radau 5 and 9. It becomes so small that their displacement is as accurate as wanted, too, unless the user set it.
  void
  prepare_for_pictures(NumericsChoice &choice, const RunParameters &parameters);
} // namespace crawler
