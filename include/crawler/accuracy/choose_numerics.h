// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/run/run_parameters.h>
#include <crawler/run/simulation.h>

#include <optional>

namespace crawler
{
  /**
   * Turns Accuracy into degree, number of cells and time tolerance; entries that the user has set are respected
   * (collective). The rule, with its constants, is explained in doc/numerics.md ("Accuracy"): pilot runs on a coarse
   * mesh with a loose tolerance measure the size of the displacement and how fast the Legendre modes of the stretch
   * decay; the mesh is refined until the predicted error of the displacement in space is below Accuracy, and the
   * tolerance is chosen such that the error in time is. Nothing is returned if @p keep_going, which is asked after
   * every step of a pilot run, returned false.
   */
  std::optional<NumericsChoice>
  choose_numerics(MPI_Comm communicator,
                  const RunParameters &parameters,
                  const Scene &scene,
                  const KeepGoing &keep_going = {});

  /// Adjusts the tolerance for pictures: at times within steps they are less accurate than the ends of the steps of
  /// radau 5 and 9. It becomes so small that their displacement is as accurate as wanted, too, unless the user set it.
  void
  prepare_for_pictures(NumericsChoice &choice, const RunParameters &parameters);
} // namespace crawler
