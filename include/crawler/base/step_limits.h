// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

namespace crawler
{
  /// A limit of the step from its time on, until the next limit.
  struct StepLimit
  {
    double from, longest;
  };

  /**
   * Returns the longest step from @p t, at most @p wanted, that the limits admit: a step may end where a smaller limit
   * begins, but must not exceed any limit within it. @p limits are @p n in ascending times. @p present is the number of
   * a limit at some earlier time, at first 0; it is advanced. (Not inline: each instruction set has its own.)
   */
  [[maybe_unused]] static double
  admitted_step(const StepLimit *limits, const unsigned int n, unsigned int &present, const double t, double wanted)
  {
    while (present + 1 < n && limits[present + 1].from <= t)
      ++present;
    for (unsigned int i = present; i < n && limits[i].from < t + wanted; ++i)
    {
      const double way = limits[i].from - t, longest = limits[i].longest > way ? limits[i].longest : way;
      wanted = longest < wanted ? longest : wanted;
    }
    return wanted;
  }
} // namespace crawler
