// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/scene_numbers.h>
#include <crawler/studies/optimize/gait_model.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// Entry that limits a number of the gait, or values at many places.
  struct LimitEntry
  {
    const char *name;
    std::optional<double> OptimizeParameters::*value;
    std::optional<GaitNumber::Index> number = {};
    LimitedValues GaitValues::*values       = nullptr;
    bool is_lower = false, is_upper = true; ///< a limit to both sides holds for the size
  };

  /// Limits in the order in which results name them.
  inline constexpr std::array<LimitEntry, 8> limit_entries = {
    {{"Work", &OptimizeParameters::work, GaitNumber::work},
     {"Positive work", &OptimizeParameters::positive_work, GaitNumber::positive_work},
     {"Dissipation", &OptimizeParameters::dissipation, GaitNumber::dissipation},
     {"Mean-square strain", &OptimizeParameters::mean_square_strain, GaitNumber::mean_square},
     {"Smallest strain", &OptimizeParameters::smallest_strain, {}, &GaitValues::strain, true, false},
     {"Largest strain", &OptimizeParameters::largest_strain, {}, &GaitValues::strain},
     {"Largest stress", &OptimizeParameters::largest_stress, {}, &GaitValues::stress, true},
     {"Largest stress rate", &OptimizeParameters::largest_stress_rate, {}, &GaitValues::stress_rate, true}}};

  /// Objective with the sign of the wanted direction.
  GaitObjective
  objective_of(const OptimizeParameters &parameters);

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

    /// Derivatives by differences of @p values of the parameters: [variable][place]. Throws InputError.
    std::vector<std::vector<double>>
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

  /// Computes gaits for the values of the variables, on some level of the model.
  class GaitModel
  {
  public:
    explicit GaitModel(SceneFamily &its_family);
    virtual ~GaitModel() = default;

    SceneFamily &family;
    const GaitWishes wishes; ///< what the objective and the limits of the family need

    /// A gait that cannot be computed (the body inverts, a formula has no value) has a problem. Derivatives of the
    /// strain are certain to exist only at @p places and for the smallest and the largest strain. Throws Interrupted.
    GaitValues
    evaluate(const std::vector<double> &x, bool with_gradients, const std::vector<std::size_t> &places = {});

    /// Checks a result more closely and refines the grid, if there is one, where it was too coarse. Returns true if it
    /// did: then the optimum is to be searched once more.
    virtual bool
    refine([[maybe_unused]] const std::vector<double> &x)
    {
      return false;
    }

    /// Smallest and largest strain over body and duration, also between the places where they are limited.
    virtual std::pair<double, double>
    extreme_strains(const std::vector<double> &x) = 0;

    /// Relative accuracy of the numbers: the optimiser cannot come closer.
    virtual double
    noise() const
    {
      return 0.;
    }

    /// Description of the model in words, for the log.
    virtual std::string
    description() const = 0;

    /// Exception: the computation was stopped from outside.
    struct Interrupted
    {
    };

  protected:
    /// Adds to @p values, whose gradients are 0, all but the active stress. Throws InputError for a problem.
    virtual void
    compute(const std::vector<double> &x,
            bool with_gradients,
            const std::vector<std::size_t> &places,
            GaitValues &values) = 0;
  };

  /// Makes the model of gaits of the kinematic level. Throws InputError if the start does not make a scene with a given
  /// strain.
  std::unique_ptr<GaitModel>
  kinematic_gait(SceneFamily &family, const std::vector<double> &start);

  /// Makes the model of gaits of the levels that are simulated. @p interrupted is called after every step. Throws
  /// InputError for a wish that only the kinematic level fulfils.
  std::unique_ptr<GaitModel>
  simulated_gait(SceneFamily &family, std::function<bool()> interrupted);
} // namespace crawler
