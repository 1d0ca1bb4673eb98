// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/parameters.h>

#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>
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

  /// "position, fused, radau 5, degree 4, 8 cells, tolerance 1e-5"
  std::string
  in_words(const TradeoffSetting &setting);

  /// The lists of section "Tradeoff", read.
  struct TradeoffLists
  {
    std::vector<std::string> models, formulations, meshes, engines, integrators;
    std::vector<unsigned int> degrees;
    std::vector<unsigned int> cells; ///< empty: automatic
    std::vector<double> mesh_tolerances, tolerances;
  };

  /// Reads and checks the lists. Throws InputError in the name of the entry at fault.
  TradeoffLists
  read_lists(const Parameters &parameters);

  /// Meshes of one degree, the coarsest first, with the error that they leave in the displacement, relative (infinite
  /// if the run fails).
  using MeshErrors = std::map<unsigned int, std::vector<std::pair<unsigned int, double>>>;

  /// Settings that differ in the time tolerance alone. They are tried from the loosest on.
  struct TradeoffFamily
  {
    TradeoffSetting setting;        ///< without tolerance
    std::vector<double> tolerances; ///< relative
    unsigned long first_index = 0;  ///< of the first tolerance; that of the i-th is i more
    std::string not_offered;        ///< why the program cannot do this; then there is one setting, without mesh
  };

  /**
   * All settings, in an order that depends on nothing but the arguments. @p meshes are those of uniform meshes for each
   * degree of the lists. On a mesh with the error e, tolerances above 1e4 e are left out. The level perturbation is one
   * setting; for kinematic the tolerances are values of Accuracy, 0.1 at first.
   */
  std::vector<TradeoffFamily>
  families(const TradeoffLists &lists, const Parameters &parameters, const Scene &scene, const MeshErrors &meshes);

  /// What is known of a setting that was tried, for next_tolerance().
  struct TriedSetting
  {
    std::string status, reason;
    double displacement; ///< not a number unless finished
  };

  /**
   * The number of the tolerance that is to be tried after those in @p tried, nothing if there is none left or if
   * - the error, the distance to @p reference, is at most the @p bar, within which the reference is known;
   * - it changed twice by less than a tenth of itself: it is that of the mesh, which no tolerance reduces;
   * - a run took too long: the others would take longer;
   * - three runs failed in succession.
   */
  std::optional<std::size_t>
  next_tolerance(const TradeoffFamily &family, const std::vector<TriedSetting> &tried, double reference, double bar);

  /// The parameters with which `crawler run` computes @p scene in this way. @p size is that to which the tolerance is
  /// relative [length]. Tolerance and first step are given, the former rounded to six digits.
  Parameters
  with_setting(const Parameters &parameters, const TradeoffSetting &setting, double size);

  /// The entries of with_setting() that differ from one setting to another, as text to paste into a parameter file.
  std::string
  as_prm(const Parameters &parameters, const TradeoffSetting &setting);
} // namespace crawler
