// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/discretization_parameters.h>
#include <crawler/output/output_parameters.h>
#include <crawler/reduced_models/model.h>
#include <crawler/scene/active_stress_library.h>
#include <crawler/scene/scene.h>
#include <crawler/time/time_parameters.h>

#include <string>

namespace crawler
{
  class Declarations;
  class ParameterFile;

  /// Entries of the parameter file for one run, in file order.
  struct RunParameters
  {
    Model model         = Model::nonlinear;
    double accuracy     = 1e-6;
    bool error_estimate = true;
    Body body;
    GroundParameters ground;
    ActiveStressParameters active_stress;
    DiscretizationParameters discretization;
    TimeParameters time;
    OutputParameters output;

    /// Makes as many terms of a sum as @p file has; to be called before add_parameters(). Throws InputError if a number
    /// is left out.
    void
    count_terms(const ParameterFile &file);

    void
    add_parameters(Declarations &declarations);

    /// Creates the physical problem. Throws InputError if entries do not fit together.
    Scene
    create_scene() const;
  };
} // namespace crawler
