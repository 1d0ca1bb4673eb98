// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <functional>
#include <vector>

namespace crawler
{
  class ActiveStress;

  /// A time during which an active stress changes faster than was known.
  struct FastChange
  {
    double from, to; ///< [time]
    double rate;     ///< about the largest |m_t| in it [force/time]
  };

  struct FastChanges
  {
    std::vector<FastChange> list; ///< in the order of their times; they may overlap
    /// Everything faster is in the list. Otherwise the generator cannot say, or there are too many.
    bool is_complete = false;
  };

  /// What the search for them leaves out.
  struct FastChangeLimits
  {
    unsigned int most_bounds = 20000; ///< that are asked for
    double least_jump        = 0.05;  ///< smaller jumps are none, relative to the largest |m|
  };

  /**
   * Looks for them in [from, to] by bounds of |m_t| in boxes (ActiveStress::bounds), which are halved in s or t
   * until the bound is explained: by what is known of that time, @p explained [force/time], or by a change of less than
   * 1e-4 of the largest |m|; or until a point of the box has a rate near the bound. So nothing is missed because it is
   * short. @p largest is the largest |m| known [force]; it is raised to what is found.
   */
  FastChanges
  find_fast_changes(const ActiveStress &stress,
                    double length,
                    double from,
                    double to,
                    const std::function<double(double, double)> &explained,
                    double &largest,
                    const FastChangeLimits &limits = {});

  /// So many times a rate that was seen explains a bound: bounds are too large.
  inline constexpr double rates_explain = 4.;
} // namespace crawler
