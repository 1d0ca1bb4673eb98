// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/accuracy/form_choice.h>

#include <algorithm>
#include <cmath>

namespace crawler
{
  namespace
  {
    /// Limits at low accuracy, the Accuracy from which on they fall, and how.
    constexpr double softest = 1e-3, emptied = 0.06, emptied_if_it_inverts = 3e-3, moderate = 1e-5;
    constexpr double softness_power = 0.5, stretch_power = 0.35;
    /// Beyond these an adaptive mesh is the cheaper one.
    constexpr double most_lengths = 30., least_accuracy = 1e-7;

    double
    falling(const double limit, const double accuracy, const double power)
    {
      return limit * std::pow(std::min(1., accuracy / moderate), power);
    }
  } // namespace

  bool
  is_soft(const double stiffness, const double exponent, const double accuracy)
  {
    return stiffness < falling(softest, accuracy, softness_power) * std::max(1., exponent * exponent);
  }

  bool
  is_cheaper_than_adaptive(const double lengths, const double accuracy)
  {
    return lengths < most_lengths && accuracy >= least_accuracy;
  }

  bool
  empties(const double smallest_stretch, const double exponent, const double accuracy)
  {
    if (exponent >= 0.) // what is contracted then slides easily
      return false;
    return smallest_stretch < falling(exponent > -1. ? emptied_if_it_inverts : emptied, accuracy, stretch_power);
  }
} // namespace crawler
