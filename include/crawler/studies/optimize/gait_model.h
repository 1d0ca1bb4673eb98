// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/adjoint/works.h>
#include <crawler/base/exceptions.h>

#include <array>
#include <optional>
#include <string>
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

  /// Objective D E^p T^q of a gait, where D is a motion, E an energy and T the time T/(gamma L).
  struct GaitObjective
  {
    const char *name, *unit;
    GaitNumber::Index motion = GaitNumber::displacement, energy = GaitNumber::work;
    double power_of_energy = 0., power_of_time = 0.;
    bool is_inverse = false; ///< true if its inverse is shown
    double sign     = 1.;    ///< sign of the wanted direction

    /// Value to be maximised of an objective that is shown, and the other way round.
    double
    turned(const double value) const
    {
      return is_inverse ? 1. / value : sign * value;
    }
  };

  /// Choices of Optimize/Objective.
  inline constexpr std::array<GaitObjective, 5> gait_objectives = {
    {{"displacement", "length"},
     {"speed", "length/time", GaitNumber::speed},
     {"cost of transport", "force", GaitNumber::displacement, GaitNumber::work, -1., 0., /*is_inverse=*/true},
     {"merit", "1", GaitNumber::displacement, GaitNumber::work, -0.5, -0.5},
     {"periodic merit", "1", GaitNumber::displacement, GaitNumber::dissipation, -0.5, -0.5}}};

  /// Value for each gait number.
  template <typename Value>
  using ByGaitNumber = std::array<Value, gait_numbers.size()>;

  /// Values that are limited at many places.
  struct LimitedValues
  {
    std::vector<double> values;
    std::vector<std::vector<double>> gradients; ///< [variable][place], if requested
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
} // namespace crawler
