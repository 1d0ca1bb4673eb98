// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/scene.h>
#include <crawler/studies/core/parameters.h>

#include <limits>
#include <string>
#include <vector>

namespace crawler
{
  /// A way to compute a scene, in the words of the parameter file. What has no meaning for it is 0 or not a number.
  struct TradeoffSetting
  {
    static constexpr double none = std::numeric_limits<double>::quiet_NaN();

    std::string model   = "nonlinear", formulation, mesh, engine, integrator;
    unsigned int degree = 0, cells = 0; ///< cells of a uniform mesh
    double mesh_tolerance = none;       ///< of an adaptive mesh, as the entry of Discretization [1]
    double tolerance      = none;       ///< in time, relative to the displacement; of a level: Accuracy [1]
    std::string not_offered;            ///< why the program cannot do this; then it has neither mesh nor tolerance

    bool
    is_batch() const
    {
      return engine == "batch";
    }
    /// A level of the model that needs no mesh; then there is nothing but model and tolerance.
    bool
    has_no_mesh() const
    {
      return model != "nonlinear";
    }
  };

  /// Whether two settings differ by the time tolerance alone.
  bool
  same_mesh(const TradeoffSetting &a, const TradeoffSetting &b);

  /// "position, fused, radau 5, degree 4, 8 cells, tolerance 1e-5"
  std::string
  in_words(const TradeoffSetting &setting);

  /**
   * All combinations of the lists in section "Tradeoff"; those of one mesh follow each other, from the loosest
   * tolerance on. What the program cannot do is one setting, whatever the meshes. The level perturbation is one
   * setting; for kinematic the tolerances are values of Accuracy, 0.1 at first. Throws InputError in the name of the
   * entry at fault.
   */
  std::vector<TradeoffSetting>
  settings_to_try(const Parameters &parameters, const Scene &scene);

  /// The parameters with which `crawler run` computes a scene in this way. @p size is that to which the tolerance is
  /// relative [length]. Tolerance and first step are given, the former rounded to six digits.
  Parameters
  with_setting(const Parameters &parameters, const TradeoffSetting &setting, double size);

  /// The entries of with_setting() that differ from one setting to another, as text to paste into a parameter file.
  std::string
  as_prm(const Parameters &parameters, const TradeoffSetting &setting);
} // namespace crawler
