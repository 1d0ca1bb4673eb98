// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/run_parameters.h>

#include <string>

namespace crawler
{
  /// Level on which a scene is computed (doc/theory.md, "The model hierarchy"), and why.
  struct ModelChoice
  {
    Model model;
    std::string explanation;

    /// True unless the level is perturbation or kinematic, without mesh and time stepper (run/reduced_model.h).
    bool
    needs_mesh() const
    {
      return model == Model::linear || model == Model::nonlinear;
    }
  };

  /**
   * Level that Model names; if it is auto the lowest one whose estimated error is at most Accuracy times the
   * displacement, or 1e-12 of the length (perturbation, kinematic, nonlinear; linear if a = 0, where the displacement,
   * being 0, cannot tell the levels apart). Throws InputError if the scene does not fit the level that Model names.
   */
  ModelChoice
  choose_model(const RunParameters &parameters, const Scene &scene);
} // namespace crawler
