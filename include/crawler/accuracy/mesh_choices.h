// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/accuracy/pilots.h>

#include <optional>

/**
 * Choices of the mesh, one for each kind (doc/numerics.md, "Accuracy"). They set `choice.numerics` from pilots and
 * leave entries that the user has set as they are. Two return the ratio of the errors of mesh and time steps, as
 * measured or predicted by the rule; nothing if there is no good mesh of the kind.
 */
namespace crawler
{
  /// Uniform mesh of at most @p most cells; of few cells if the solution @p may_be_steep.
  std::optional<double>
  choose_uniform_mesh(Pilots &pilots, NumericsChoice &choice, unsigned int most, bool may_be_steep);

  /**
   * Mesh that is graded towards the ends and breaks in space, for an active stress that starts or jumps suddenly
   * ("Jumps and sudden starts"): cells, levels and tolerance are each refined until that would change the displacement
   * by less than a quarter of the wanted error. Nothing if a run breaks off or nearly loses a stretch, or if the mesh
   * would become too fine.
   */
  std::optional<double>
  choose_graded_mesh(Pilots &pilots, NumericsChoice &choice);

  /// Adaptive mesh: pilots measure the strain, which scales its tolerance, and the number of steps.
  void
  choose_adaptive_mesh(Pilots &pilots, NumericsChoice &choice);

  /// Mesh for jumps of the active stress that move, where every method is of order 1 in the cell size: it is doubled
  /// until the displacement settles, or until too many cells would be needed. The error that is left is the one that is
  /// reported.
  void
  choose_mesh_for_moving_jumps(Pilots &pilots, NumericsChoice &choice);

  /// Stretch form: the first of a family of meshes (mesh_family.h), or the user's settings.
  void
  choose_stretch_form(const Pilots &pilots, NumericsChoice &choice);
} // namespace crawler
