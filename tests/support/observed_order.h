// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace crawler::test
{
  /// Slope of log(error) over log(n) by least squares, with the sign that makes a convergent method positive; printed
  /// with the name of the @p method.
  inline double
  observed_order(const std::string &method, const std::vector<double> &n, const std::vector<double> &error)
  {
    double sx = 0., sy = 0., sxx = 0., sxy = 0.;
    const auto count = static_cast<double>(n.size());
    for (std::size_t i = 0; i < n.size(); ++i)
    {
      const double x = std::log(n[i]), y = std::log(error[i]);
      sx += x;
      sy += y;
      sxx += x * x;
      sxy += x * y;
    }
    const double order = -(count * sxy - sx * sy) / (count * sxx - sx * sx);
    fmt::print("{}: errors {:.2e} with {} to {:.2e} with {}, observed order {:.2f}\n",
               method,
               error.front(),
               n.front(),
               error.back(),
               n.back(),
               order);
    return order;
  }
} // namespace crawler::test
