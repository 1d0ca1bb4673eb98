// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

namespace crawler::test
{
  /// Derivative of @p f at 0, by central differences of fourth order.
  inline std::vector<double>
  derivative(const std::function<std::vector<double>(double step)> &f)
  {
    constexpr double e = 1e-4;
    const auto plus = f(e), minus = f(-e), plus_2 = f(2. * e), minus_2 = f(-2. * e);
    std::vector<double> result(plus.size());
    for (std::size_t i = 0; i < result.size(); ++i)
      result[i] = (8. * (plus[i] - minus[i]) - (plus_2[i] - minus_2[i])) / (12. * e);
    return result;
  }
} // namespace crawler::test
