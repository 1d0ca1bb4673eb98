// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <vector>

namespace crawler
{
  /// Quadrature on [0, 1], with the points in ascending order; the sum of the weights is 1.
  struct QuadratureRule
  {
    std::vector<double> points, weights;
  };

  /// The Gauss-Legendre formula with @p n points, n >= 1.
  QuadratureRule
  gauss_rule(unsigned int n);

  /// The Gauss-Lobatto formula with @p n points, n >= 2, of which two are the ends.
  QuadratureRule
  gauss_lobatto_rule(unsigned int n);
} // namespace crawler
