// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/simulation.h>

#include <functional>
#include <string>
#include <vector>

namespace crawler::test
{
  /// A method with all that is to be chosen for it.
  struct Setting
  {
    TimeParameters time;
    Numerics numerics;
  };

  /// "radau 9, degree 7, 3 cells, tolerance 1.2e-05"
  std::string
  in_words(const Setting &setting);

  /// Which settings are tried: all combinations.
  struct SearchSpace
  {
    std::string engine; ///< as Time/Engine
    std::vector<std::string> integrators;
    std::vector<unsigned int> degrees, cells;
    double loosest, tightest;       ///< tolerances [length]
    double end_time;                ///< [time]
    double tolerance_factor = 0.66; ///< from one tolerance to the next
  };

  /// Makes everything ready for a setting; the function that it returns runs it and gives the relative error, which is
  /// infinite if it fails.
  using Prepare = std::function<std::function<double()>(const Setting &)>;

  /// The cheapest of the settings, in processor time, that reach a relative error of @p wanted and that @p confirm
  /// agrees to. Throws if there is none.
  Setting
  cheapest_setting(const SearchSpace &space,
                   double wanted,
                   const Prepare &prepare,
                   const std::function<bool(const Setting &)> &confirm);
} // namespace crawler::test
