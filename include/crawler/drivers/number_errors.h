// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <array>
#include <cstddef>
#include <limits>

namespace crawler
{
  struct SimulationResult;

  /// Error bars of the numbers of a summary besides the displacement; not a number where unknown.
  struct NumberErrors
  {
    static constexpr std::size_t n = 16;

    /// Their keys in summary.json, dots for nesting.
    static const std::array<const char *, n> &
    keys();

    std::array<double, n> values;

    NumberErrors()
    {
      values.fill(std::numeric_limits<double>::quiet_NaN());
    }
  };

  /**
   * The errors of the numbers of @p result from those of a @p finer run, measured as the displacement's is
   * (error_estimate.h): @p factor times the difference x of both, and @p part of the scale S of the number, which is
   * the exchanged work for works and energies, the largest strain for stretches, and the number itself for others:
   *
   *   error = factor x + part S.
   *
   * Numbers that are found by looking at N quadrature points along the body, where the sign of the power changes or the
   * stretch is extreme, converge more slowly; theirs is 1.5 factor x + (part + 2/N^2) S (doc/numerics.md, "Error
   * bars").
   */
  NumberErrors
  number_errors(const SimulationResult &result, const SimulationResult &finer, double factor, double part);
} // namespace crawler
