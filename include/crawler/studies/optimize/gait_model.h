// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/works.h>
#include <crawler/base/exceptions.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// Number of which objective and limits of a gait are made, in the user's units.
  struct GaitNumber
  {
    enum Index : std::size_t
    {
      displacement,
      work,          ///< stress work over the duration
      positive_work, ///< positive stress work over the duration
      mean_square,   ///< mean square of the strain
      speed,
      friction_time, ///< T/(gamma L): the merit is D/sqrt(W T/(gamma L))
      dissipation,
      efficiency ///< relative to the best of all gaits with its energy and strains; not differentiated
    };

    const char *words, *column, *unit;
    std::optional<Quantity> quantity = {}; ///< quantity that the adjoint differentiates
  };

  /// Gait numbers by their index.
  inline constexpr std::array<GaitNumber, 8> gait_numbers = {
    {{"displacement", "displacement", "length", Quantity::displacement},
     {"work", "stress_power", "energy", Quantity::stress_work},
     {"positive work", "positive_power", "energy", Quantity::positive_work},
     {"mean-square strain", "mean_square_strain", "1"},
     {"speed", "speed", "length/time", Quantity::speed},
     {"T/(gamma L)", "friction_time", "time^2/(force length)"},
     {"dissipation", "dissipation", "energy", Quantity::dissipation},
     {"efficiency", "efficiency", "1"}}};

  /// Value for each gait number.
  template <typename Value>
  using ByGaitNumber = std::array<Value, gait_numbers.size()>;

  /// Values that are limited at many places, and their derivatives by the variables: [place][variable].
  struct LimitedValues
  {
    std::vector<double> values;
    std::shared_ptr<const std::vector<double>> jacobian; ///< null unless requested
  };

  /// Numbers of a gait.
  struct GaitValues
  {
    std::string problem;              ///< in words; empty if there is none
    std::string problem_of_gradients; ///< problem of the derivatives alone
    ByGaitNumber<double> numbers{};
    ByGaitNumber<std::vector<double>> gradients; ///< by the variables, if requested
    std::vector<bool> by_differences;            ///< variables whose gradients are differences of gaits; empty: none
    std::vector<bool> strain_by_differences;     ///< variables whose gradients of the extreme strains are differences
    LimitedValues strain, stress, stress_rate;   ///< values that are limited

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

  /// Selection of the numbers and values of a gait.
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

    /// A gait that cannot be computed (the body inverts, a formula has no value) has a problem. Derivatives of the
    /// strain are certain to exist only at @p places and for the smallest and the largest strain. Throws Interrupted.
    virtual GaitValues
    evaluate(const std::vector<double> &x, bool with_gradients, const std::vector<std::size_t> &places = {}) = 0;

    /// Checks a result more closely and refines the grid if it was too coarse. Returns true if it did: then the optimum
    /// is to be searched once more.
    virtual bool
    refine(const std::vector<double> &x) = 0;

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
  };
} // namespace crawler
