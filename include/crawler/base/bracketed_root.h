// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <boost/math/tools/toms748_solve.hpp>

namespace crawler
{
  /// Root of @p function in [@p from, @p to], at whose ends it has different signs.
  template <typename Function>
  double
  bracketed_root(const Function &function, const double from, const double to)
  {
    std::uintmax_t iterations = 200;
    const auto [before, after] =
      boost::math::tools::toms748_solve(function, from, to, boost::math::tools::eps_tolerance<double>(52), iterations);
    return 0.5 * (before + after);
  }
} // namespace crawler
