// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/optimize/gait_model.h>

#include <array>
#include <functional>
#include <optional>
#include <vector>

namespace crawler
{
  /// Entry that limits gaits.
  struct LimitEntry
  {
    const char *name;
    std::optional<double> OptimizeParameters::*value;
    std::optional<GaitNumber::Index> number = {}; ///< unset: a limit of values at many places
  };

  /// Limits in the order in which results name them.
  inline constexpr std::array<LimitEntry, 8> limit_entries = {
    {{"Work", &OptimizeParameters::work, GaitNumber::work},
     {"Positive work", &OptimizeParameters::positive_work, GaitNumber::positive_work},
     {"Dissipation", &OptimizeParameters::dissipation, GaitNumber::dissipation},
     {"Mean-square strain", &OptimizeParameters::mean_square_strain, GaitNumber::mean_square},
     {"Smallest strain", &OptimizeParameters::smallest_strain},
     {"Largest strain", &OptimizeParameters::largest_strain},
     {"Largest stress", &OptimizeParameters::largest_stress},
     {"Largest stress rate", &OptimizeParameters::largest_stress_rate}}};

  /// Scenes that the variables of an optimisation make (Optimize/Variables).
  class SceneFamily
  {
  public:
    /// @p its_form must outlive it. Throws InputError as read_variables() does, and for an objective without maximum:
    /// one that no limit bounds.
    explicit SceneFamily(Form &its_form);
    SceneFamily(const SceneFamily &) = delete;
    /// Restores the form.
    ~SceneFamily();

    Form &form;
    const std::vector<Variable> variables;

    /// Throws InputError.
    Parameters
    parameters(const std::vector<double> &x);

    /// Values at which start @p number begins: those of the file for the first, random ones about them for the others.
    std::vector<double>
    start(unsigned long number) const;

    /// Scale on which variable @p i changes a gait: about its value, here or at the start; between 0.01 and 1 of its
    /// range.
    double
    scale(const std::vector<double> &x, std::size_t i) const;

    /// Points of a stencil about variable @p i, all in its range, by their offset from x, and the weights of the values
    /// there in the derivative, of fourth order inside the range. @p relative_step: in scales of the variable.
    struct StencilPoint
    {
      double offset, weight;
      std::vector<double> x;
    };
    std::vector<StencilPoint>
    stencil(const std::vector<double> &x, std::size_t i, double relative_step) const;

    /// Derivatives by differences of @p values of the parameters: [place][variable]. Throws InputError.
    std::vector<double>
    differences(const std::vector<double> &x,
                const std::function<std::vector<double>(const Parameters &)> &values,
                double relative_step);

    /// Active stress (@p rate: its rate) on a grid over body and duration, where it is limited.
    LimitedValues
    stress(const std::vector<double> &x, bool rate, bool with_gradients);

    /// Largest magnitude of the active stress or its rate, also between the points of that grid.
    double
    largest_stress(const std::vector<double> &x, bool rate);
  };

  /// Makes the model of gaits of the kinematic level. Throws InputError if the start does not make a scene with a given
  /// strain.
  std::unique_ptr<GaitModel>
  kinematic_gait(SceneFamily &family, const GaitWishes &wishes, const std::vector<double> &start);

  /// Makes the model of gaits of the levels that are simulated. @p interrupted is called after every step. Throws
  /// InputError for a wish that only the kinematic level fulfils.
  std::unique_ptr<GaitModel>
  simulated_gait(SceneFamily &family, const GaitWishes &wishes, std::function<bool()> interrupted);
} // namespace crawler
