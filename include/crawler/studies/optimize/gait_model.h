// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// What objective and limits of a gait are made of, in the user's units.
  enum class GaitNumber
  {
    displacement,
    work,          ///< of the active stress over the duration
    positive_work, ///< the same
    mean_square,   ///< of the strain
    speed,
    friction_time, ///< T/(gamma L): the merit is D/sqrt(W T/(gamma L))
    dissipation,
    efficiency ///< part of what any gait with its energy and strains could; not differentiated
  };
  inline constexpr std::size_t n_gait_numbers = 8;

  /// A value for each of them.
  template <typename Value>
  struct ByGaitNumber : std::array<Value, n_gait_numbers>
  {
    using std::array<Value, n_gait_numbers>::operator[];

    Value &
    operator[](const GaitNumber one)
    {
      return (*this)[static_cast<std::size_t>(one)];
    }
    const Value &
    operator[](const GaitNumber one) const
    {
      return (*this)[static_cast<std::size_t>(one)];
    }
  };

  /// Numbers that are limited at many places, and their derivatives by the variables: [place][variable].
  struct LimitedValues
  {
    std::vector<double> values;
    std::shared_ptr<const std::vector<double>> jacobian; ///< if it was asked for
  };

  /// What a gait gives.
  struct GaitValues
  {
    std::string problem;              ///< in words; empty if all is well
    std::string problem_of_gradients; ///< the same, of the derivatives alone
    ByGaitNumber<double> numbers{};
    ByGaitNumber<std::vector<double>> gradients; ///< by the variables, if they were asked for
    std::vector<bool> by_differences; ///< for which variables the gradients are differences of gaits; empty: for none
    std::vector<bool> strain_by_differences;   ///< the same of the extreme strains
    LimitedValues strain, stress, stress_rate; ///< of what is limited

    /// Throws InputError if the start has a problem.
    void
    require_start() const
    {
      if (!problem.empty())
        throw InputError("the start cannot be computed: " + problem, "Optimize/Variables");
      if (!problem_of_gradients.empty())
        throw InputError("the start has no derivatives: " + problem_of_gradients, "Optimize/Variables");
    }
  };

  /// Which of them are wanted.
  struct GaitWishes
  {
    ByGaitNumber<bool> numbers{};
    bool strain = false, stress = false, stress_rate = false;
  };

  /// Computes gaits for the values of the variables, on some level of the model.
  class GaitModel
  {
  public:
    virtual ~GaitModel() = default;

    /// A gait that cannot be computed (the body inverts, a formula has no value) has a problem. Of the strains those of
    /// @p places have derivatives for sure, and the smallest and the largest. Throws Interrupted.
    virtual GaitValues
    evaluate(const std::vector<double> &x, bool with_gradients, const std::vector<std::size_t> &places = {}) = 0;

    /// Looks at a result more closely: makes the grid finer if it was too coarse there. Returns whether it did, so that
    /// the optimum is to be looked for once more.
    virtual bool
    refine(const std::vector<double> &x) = 0;

    /// The smallest and the largest strain over body and duration, between the places where they are limited, too.
    virtual std::pair<double, double>
    extreme_strains(const std::vector<double> &x) = 0;

    /// How exact the numbers are, relative: the optimiser cannot come closer.
    virtual double
    noise() const
    {
      return 0.;
    }

    /// In words, for the log.
    virtual std::string
    description() const = 0;

    /// The computation was stopped from outside.
    struct Interrupted
    {
    };
  };
} // namespace crawler
