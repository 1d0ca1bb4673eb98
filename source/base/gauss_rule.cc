// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/gauss_rule.h>

#include <boost/math/special_functions/legendre.hpp>

namespace crawler
{
  namespace
  {
    using Real = long double; // makes the rules exact to the last bit

    Real
    legendre(const unsigned int n, const Real x)
    {
      return boost::math::legendre_p(static_cast<int>(n), x);
    }

    /// (1 - x^2) P_n'(x)
    Real
    legendre_slope(const unsigned int n, const Real x)
    {
      return n * (legendre(n - 1, x) - x * legendre(n, x));
    }

    /// Builds a rule symmetric about 1/2 from its points x > 0 of [-1, 1], in ascending order, and 0 if n is odd.
    template <typename Weight>
    QuadratureRule
    symmetric(const std::vector<Real> &right, const unsigned int n, const Weight &weight)
    {
      QuadratureRule rule{std::vector<double>(n), std::vector<double>(n)};
      for (std::size_t i = 0; i < right.size(); ++i)
      {
        const std::size_t last = n - right.size() + i, first = n - 1 - last;
        rule.points[last]   = static_cast<double>((1 + right[i]) / 2);
        rule.points[first]  = static_cast<double>((1 - right[i]) / 2);
        rule.weights[first] = rule.weights[last] = static_cast<double>(weight(right[i]) / 2);
      }
      return rule;
    }
  } // namespace

  QuadratureRule
  gauss_rule(const unsigned int n)
  {
    return symmetric(boost::math::legendre_p_zeros<Real>(static_cast<int>(n)), n, [n](const Real x) {
      const Real slope = legendre_slope(n, x);
      return 2 * (1 - x * x) / (slope * slope);
    });
  }

  QuadratureRule
  gauss_lobatto_rule(const unsigned int n)
  {
    // The inner points are the zeros of P_{n-1}', one between each pair of neighbouring zeros of P_{n-1}.
    const std::vector<Real> zeros = boost::math::legendre_p_zeros<Real>(static_cast<int>(n) - 1);
    std::vector<Real> points;
    if (n % 2 == 1)
      points.push_back(0);
    for (std::size_t i = 0; i + 1 < zeros.size(); ++i)
    {
      Real x = (zeros[i] + zeros[i + 1]) / 2;
      for (int iteration = 0; iteration < 8; ++iteration) // ((1 - x^2) P')' = -n (n - 1) P
        x += legendre_slope(n - 1, x) / (n * (n - 1) * legendre(n - 1, x));
      points.push_back(x);
    }
    points.push_back(1);
    return symmetric(points, n, [n](const Real x) {
      const Real value = legendre(n - 1, x);
      return 2 / (n * (n - 1) * value * value);
    });
  }
} // namespace crawler
