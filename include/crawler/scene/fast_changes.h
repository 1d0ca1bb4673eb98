// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/scene/active_stress.h>

#include <functional>
#include <vector>

namespace crawler
{
  /// A time interval in which an active stress changes faster than was known.
  struct FastChange
  {
    double from, to; ///< [time]
    double rate;     ///< approximate largest |m_t| [force/time]
  };

  struct FastChanges
  {
    std::vector<FastChange> list; ///< in the order of their times; they may overlap
    /// True if everything faster is in the list. Otherwise the generator cannot tell, or there are too many.
    bool is_complete = false;
  };

  /// Limits of the search.
  struct FastChangeLimits
  {
    unsigned int max_bounds = 20000; ///< bounds evaluated at most
    double min_jump         = 0.05;  ///< smaller jumps are ignored, relative to the largest |m|
  };

  /**
   * Finds fast changes in [from, to] by bounds of |m_t| in boxes (ActiveStress::bounds), which are halved in s or t
   * until the bound is explained: by the known rate at that time, @p explained [force/time], or by a change of less
   * than 1e-4 of the largest |m|; or until a point of the box has a rate near the bound. So no change is missed for
   * being short. @p largest is the largest |m| known [force]; it is raised to the largest found.
   */
  FastChanges
  find_fast_changes(const ActiveStress &stress,
                    double length,
                    double from,
                    double to,
                    const std::function<double(double, double)> &explained,
                    double &largest,
                    const FastChangeLimits &limits = {});

  /// The largest |m| and |m_t| at @p n_s times @p n_t points of a box; from differences of m if its rate is not known.
  ActiveStress::Bounds
  sampled_bounds(const ActiveStress &stress, const ActiveStress::Box &box, unsigned int n_s, unsigned int n_t);

  /// Multiple of a known rate up to which it explains a bound: bounds are too large.
  inline constexpr double rates_explain = 4.;
} // namespace crawler
