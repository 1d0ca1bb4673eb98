// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <optional>

namespace crawler
{
  /// A value of the strain with its place.
  struct StrainExtreme
  {
    double strain, s, t;
  };

  struct StrainExtremes
  {
    StrainExtreme smallest, largest;
  };

  /// A change of the strain in time that its rate does not explain.
  struct StrainJump
  {
    double s, from, to; ///< place, and times before and after
    double change;      ///< of the strain
    double integral;    ///< of its rate
  };

  /**
   * Finds a jump of the strain in time, of more than 1e-6 of its largest value: results from the rate of such a strain
   * are wrong. Changes at some points over some intervals are compared with the integrals of the rate; two jumps that
   * cancel within an interval (1/37 of the duration) are not seen.
   */
  std::optional<StrainJump>
  find_jump(const ActiveStress &strain, double length, double end_time);

  /// Finds extremes on a grid of @p n_s times @p n_t points over the whole body and 0 <= t <= @p end_time, ends
  /// included, and from its eight highest peaks by a search with shrinking steps (to 1e-4 of those of the grid). A
  /// strain that is not a finite number somewhere is the smallest and the largest.
  StrainExtremes
  find_extremes(const ActiveStress &strain, double length, double end_time, unsigned int n_s, unsigned int n_t);
} // namespace crawler
