// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/formula/formula.h>

#include <optional>
#include <vector>

namespace crawler
{
  /// Places [0, length] and times [0, end time] of a formula's jumps and kinks, ascending. Nothing if there are too
  /// many to find, or if round-off hides them.
  struct FormulaBreaks
  {
    std::optional<std::vector<double>> in_space, in_time;
  };

  /**
   * Finds the jumps and kinks of a formula that do not move: where an operation on s alone, or on t alone, changes its
   * side (a comparison, sign, abs, min, max, floor, ceil, rint, mod), or one on t and steps of s, as in
   * mod(t - floor(4*s)/4, 1) < 0.5. Intervals are halved until enclosures exclude that, so no break is missed, however
   * close the next one is. An end time of 0: only places.
   */
  FormulaBreaks
  formula_breaks(const std::shared_ptr<const Formula> &formula, double length, double end_time);
} // namespace crawler
