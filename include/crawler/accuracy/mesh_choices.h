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
  /// Constants that several choices have in common. Measured by tests/verification/calibration.cc and
  /// tests/benchmark/setting_search.cc.
  namespace mesh_choice
  {
    inline constexpr unsigned int min_cells = 4, max_cells = 4096;
    /// Stretch below which a pilot that breaks off has lost it.
    inline constexpr double emptied = 0.1;
    /// Limit on the cells of uniform meshes of pilots.
    inline constexpr unsigned int max_uniform_cells = 1024;
    /// Factor on the sum of the error indicators over the strain: a bound of the relative error of the displacement.
    inline constexpr double indicator_factor = 8.;
    /// Limit of `unresolved` below which a pilot's mesh is good enough to predict others.
    inline constexpr double resolved = 1e-3;
    /// Size of a start or jump of the stress, relative to the largest stress, over the root of Accuracy, above which
    /// layers count.
    inline constexpr double sudden_part = 0.1;
    /// Meshes for moving jumps: the coarsest, and its tolerance.
    inline constexpr unsigned int moving_degree = 2, first_moving_cells = 64;
    inline constexpr double moving_tolerance = 0.1;
    /// Bodies softer than this, in natural units, have layers that the error indicators do not see, and uniform meshes
    /// not at all.
    inline constexpr double very_soft = 2e-5;
  } // namespace mesh_choice

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

  /// First step of a run or piece on a graded mesh [time]: the smallest cells come to rest in it, whatever the active
  /// stress did, and Newton's method converges.
  double
  first_step_on_graded_mesh(const Scene &scene, const Numerics &numerics);

  /// Settings of @p numerics, whose mesh is graded, with a mesh that is certainly finer.
  Numerics
  with_finer_grading(const Scene &scene, const Numerics &numerics);

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
