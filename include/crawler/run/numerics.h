// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/base/step_limits.h>
#include <crawler/equation/stretch_form.h>
#include <crawler/mesh/graded_mesh.h>
#include <crawler/mesh/mesh_marking.h>

#include <string>
#include <vector>

namespace crawler
{
  /// Numerical settings of one simulation; choose_numerics() chooses those that the user leaves open.
  struct Numerics
  {
    unsigned int degree                = 0;
    unsigned int n_cells               = 0;  ///< number of cells of the first mesh
    double tolerance                   = 0.; ///< [length]
    double initial_step                = 0.; ///< [time]
    std::vector<StepLimit> step_limits = {}; ///< limits of adaptive steps [time]
    double min_event = 0.; ///< size [force] from which on an event of the active stress within a step makes it be
                           ///< repeated; 0: events are not looked for
    Formulation formulation = Formulation::position;
    MeshLimits mesh         = {};    ///< limits of an adaptive mesh
    std::string integrator  = "bdf"; ///< integrator that replaces an automatic one (time/integrators.h)
    Grading grading         = {};    ///< grading of the first mesh, which has n_cells cells without it
    double layer            = 0.;    ///< size of layers in the stretch form, see layered_cell_ends() [length]; 0: none
    unsigned int parts      = 1;     ///< cells of the stretch form into which each of n_cells is divided
    bool other_rule         = false; ///< stretch form with the other rule, see stretch_method()
    bool jumps_move         = false; ///< the active stress jumps at places that move through the cells

    void
    exchange(Archive &archive)
    {
      archive(degree, n_cells, tolerance, initial_step, step_limits, min_event, formulation, integrator, layer);
      // Members one by one, since bytes between the members of a struct may differ.
      archive(mesh.tolerance, mesh.smallest_cell, mesh.most_cells, grading.levels, grading.ratio);
      archive(parts, other_rule, jumps_move);
    }
  };

  struct TimeParameters;

  /// Name of the integrator: that of the entry, or if this is automatic that of the @p numerics.
  const std::string &
  integrator_of(const TimeParameters &time, const Numerics &numerics);

  /// Converts numerics to natural units.
  Numerics
  in_units(Numerics numerics, const Units &units);

  /// Ends of the cells of the first mesh, for a body of length 1: at the breaks in space, and graded as requested.
  /// Empty if they are n_cells of one size.
  std::vector<double>
  first_cell_ends(const Scene &scene, const Numerics &numerics);
} // namespace crawler
