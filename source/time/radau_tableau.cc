// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/time/radau_tableau.h>

#include <boost/math/special_functions/legendre.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <stdexcept>
#include <tuple>

namespace crawler
{
  namespace
  {
    // Extended precision: the eigenvectors are nearly parallel.
    using Real    = long double;
    using Complex = std::complex<Real>;

    /// The Radau points in (0, 1]: the zeros of P_s - P_{s-1} by Newton's method from those of a Chebyshev polynomial.
    std::vector<Real>
    radau_points(const int n)
    {
      std::vector<Real> points;
      for (int j = n - 1; j >= 0; --j)
      {
        Real y = std::cos(2 * std::numbers::pi_v<Real> * j / (2 * n - 1));
        for (int iteration = 0; j > 0 && iteration < 10; ++iteration)
          y -= (boost::math::legendre_p(n, y) - boost::math::legendre_p(n - 1, y)) /
               (boost::math::legendre_p_prime(n, y) - boost::math::legendre_p_prime(n - 1, y));
        points.push_back((1 + y) / 2);
      }
      return points;
    }

    /// Derivatives 0, 1, 2, ... at x of the polynomial with these zeros and the leading coefficient 1.
    std::vector<Real>
    derivatives(const std::span<const Real> zeros, const Real x)
    {
      std::vector<Real> result = {1}; // coefficients of the powers of the distance from x, then times factorials
      for (const Real zero : zeros)
      {
        result.push_back(0);
        for (std::size_t i = result.size() - 1; i-- > 0;)
        {
          result[i + 1] += result[i];
          result[i] *= x - zero;
        }
      }
      for (std::size_t i = 2; i < result.size(); ++i)
        result[i] *= std::tgamma(static_cast<Real>(i + 1));
      return result;
    }

    /// c[0] + c[1] z + c[2] z^2 + ...
    Complex
    value(const std::span<const Real> c, const Complex z)
    {
      return std::accumulate(
        c.rbegin(), c.rend(), Complex(0), [z](const Complex sum, const Real next) { return sum * z + next; });
    }

    /// All zeros of a polynomial with a leading coefficient of 1 at once (Weierstrass), which are simple and at most
    /// one of them real: the real one first, then pairs with falling imaginary parts, in each pair the positive one
    /// first.
    std::vector<Complex>
    zeros_of(const std::span<const Real> c)
    {
      const std::size_t n = c.size() - 1;
      std::vector<Complex> zeros;
      Real size = 0;
      for (std::size_t k = 0; k < n; ++k)
        size = std::max(size, std::pow(std::abs(c[k]), Real(1) / static_cast<Real>(n - k)));
      for (std::size_t k = 0; k < n; ++k)
        zeros.push_back(std::polar(size, Real(2.5) * static_cast<Real>(k) + Real(0.4)));
      for (int iteration = 0; iteration < 200; ++iteration)
        for (std::size_t k = 0; k < n; ++k)
        {
          Complex others = 1;
          for (std::size_t i = 0; i < n; ++i)
            if (i != k)
              others *= zeros[k] - zeros[i];
          zeros[k] -= value(c, zeros[k]) / others;
        }
      std::ranges::sort(zeros, {}, [](const Complex &zero) {
        constexpr Real round_off = 1e-8L;
        const Real imaginary     = std::abs(zero.imag());
        return std::tuple(imaginary > round_off, -std::round(imaginary / round_off), -zero.imag());
      });
      zeros[0] = zeros[0].real();
      return zeros;
    }
  } // namespace

  // With M = (x - c_1) ... (x - c_s) and z an eigenvalue of A^-1, which maps the values at c of a polynomial p of
  // degree s with p(0) = 0 to those of p':
  //   p = M + M'/z + M''/z^2 + ... has p' = z (p - M) and so is an eigenvector if p(0) = 0;
  //   b y is an eigenvector of the transposed matrix for y = N - N'/z + N''/z^2 - ..., N = M/(x - 1), since b
  //   integrates exactly.
  RadauTableau::RadauTableau(const unsigned int n_stages)
    : n(n_stages)
    , newton_fraction(n_stages == 5 ? 1e-4 : 1e-3)
  {
    const std::vector<Real> points = radau_points(static_cast<int>(n)), at_start = derivatives(points, 0);
    std::vector<Real> slopes, weights;
    for (const Real x : points)
    {
      slopes.push_back(derivatives(points, x)[1]);
      weights.push_back(x / std::pow(n * boost::math::legendre_p(static_cast<int>(n) - 1, 2 * x - 1), Real(2)));
    }
    c.assign(points.begin(), points.end());
    b.assign(weights.begin(), weights.end());
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        inverse.push_back(
          static_cast<double>(i == j ? 1 / points[i] + derivatives(points, points[i])[2] / (2 * slopes[i])
                                     : points[i] / points[j] * slopes[i] / slopes[j] / (points[i] - points[j])));

    std::vector<Real> characteristic(at_start.rbegin(), at_start.rend()); // z^s M(0) + z^(s-1) M'(0) + ... = 0
    for (Real &coefficient : characteristic)
      coefficient /= at_start[0];
    std::vector<Complex> kept = zeros_of(characteristic);
    for (unsigned int k = 1; k < kept.size(); ++k) // without the second one of each pair
      kept.erase(kept.begin() + k + 1);
    real_eigenvalue = static_cast<double>(kept[0].real());
    eigenvalues.assign(kept.begin() + 1, kept.end());
    vectors.resize(n * kept.size());
    for (std::size_t k = 0; k < kept.size(); ++k)
    {
      std::vector<Complex> vector, row;
      Complex product = 0;
      for (unsigned int i = 0; i < n; ++i)
      {
        vector.push_back(value(derivatives(points, points[i]), Real(1) / kept[k]));
        row.push_back(weights[i] * value(derivatives({points.data(), n - 1}, points[i]), Real(-1) / kept[k]));
        product += row[i] * vector[i];
      }
      for (unsigned int i = 0; i < n; ++i)
      {
        vectors[i * kept.size() + k] = std::complex<double>(vector[i] / vector.back());
        rows.emplace_back(row[i] * vector.back() / product);
      }
    }

    // The weights b^ integrate polynomials up to degree s-1 exactly together with the weight gamma_0 of f(0), so with
    // l_j: b^_j = b_j - gamma_0 l_j(0); the sum of l_j(0) A^-1_jl is the derivative at 0 of x l_l/c_l.
    for (unsigned int l = 0; l < n; ++l)
      error_weights.push_back(static_cast<double>(at_start[0] / (kept[0].real() * points[l] * slopes[l] * points[l])));
  }

  const RadauTableau &
  radau_tableau(const unsigned int n_stages)
  {
    static const RadauTableau three(3), five(5), seven(7);
    if (n_stages != 3 && n_stages != 5 && n_stages != 7)
      throw std::logic_error("Radau IIA is available with 3, 5 and 7 stages");
    return n_stages == 3 ? three : n_stages == 5 ? five : seven;
  }
} // namespace crawler
