// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation.h>

#include <functional>
#include <optional>

namespace crawler
{
  /// First step of a run or piece on a graded mesh [time]: the smallest cells come to rest in it, whatever the active
  /// stress did, and Newton's method converges.
  double
  first_step_on_graded_mesh(const Scene &scene, const Numerics &numerics);

  /// Settings of @p numerics, whose mesh is graded, with a mesh that is certainly finer.
  Numerics
  with_finer_grading(const Scene &scene, const Numerics &numerics);

  /// Requirements on a graded mesh.
  struct GradedTask
  {
    const Scene &scene;
    Numerics start;          ///< all settings but mesh and tolerance; its n_cells is where the search starts
    double accuracy;         ///< wanted error of the displacement, relative to its size
    double scale;            ///< scale of the displacement, before anything is known [length]
    bool choose_tolerance;   ///< otherwise that of start is used
    bool choose_first_step;  ///< otherwise that of start is used
    double tolerance_factor; ///< the first tolerance, relative to the wanted error
    double layer;            ///< size of the smallest cells of the first mesh, relative to the length; 0: any
    std::function<SimulationResult(const Numerics &)> run;
    std::function<double(const SimulationResult &)> size; ///< size of the displacement, to which accuracy is relative
  };

  struct GradedChoice
  {
    Numerics numerics;
    SimulationResult result;
    double space_over_time; ///< ratio of the errors, as observed
    double rest;            ///< error that may remain because the cells may not be smaller [length]
  };

  /**
   * Finds the cells, levels and tolerance for an active stress that starts or jumps suddenly (doc/numerics.md, "Jumps
   * and sudden starts"): each is refined until further refinement would change the displacement by less than a quarter
   * of the wanted error. Nothing if a run breaks off or nearly loses a stretch, or if the mesh would become too fine.
   */
  std::optional<GradedChoice>
  find_graded_mesh(const GradedTask &task);
} // namespace crawler
