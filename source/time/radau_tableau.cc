// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/bracketed_root.h>
#include <crawler/time/radau_tableau.h>

#include <boost/math/special_functions/legendre.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <tuple>
#include <utility>

namespace crawler
{
  namespace
  {
    // Extended precision: the eigenvectors are nearly parallel.
    using Real    = long double;
    using Complex = std::complex<Real>;

    /// A square matrix, row by row.
    template <typename Number>
    struct Matrix
    {
      explicit Matrix(const unsigned int n)
        : n(n)
        , entries(static_cast<std::size_t>(n) * n, Number(0))
      {
      }
      Number &
      operator()(const unsigned int i, const unsigned int j)
      {
        return entries[i * n + j];
      }
      const Number &
      operator()(const unsigned int i, const unsigned int j) const
      {
        return entries[i * n + j];
      }
      const unsigned int n;
      std::vector<Number> entries;
    };

    /// Inverts by Gauss-Jordan elimination with pivoting.
    template <typename Number>
    Matrix<Number>
    inverse_of(Matrix<Number> a)
    {
      const unsigned int n = a.n;
      Matrix<Number> result(n);
      for (unsigned int i = 0; i < n; ++i)
        result(i, i) = 1;
      for (unsigned int k = 0; k < n; ++k)
      {
        unsigned int pivot = k;
        for (unsigned int i = k + 1; i < n; ++i)
          if (std::abs(a(i, k)) > std::abs(a(pivot, k)))
            pivot = i;
        const Number scale = Number(1) / a(pivot, k);
        for (unsigned int j = 0; j < n; ++j)
        {
          std::swap(a(k, j), a(pivot, j));
          std::swap(result(k, j), result(pivot, j));
          a(k, j) *= scale;
          result(k, j) *= scale;
        }
        for (unsigned int i = 0; i < n; ++i)
        {
          const Number factor = i == k ? Number(0) : a(i, k);
          for (unsigned int j = 0; j < n; ++j)
          {
            a(i, j) -= factor * a(k, j);
            result(i, j) -= factor * result(k, j);
          }
        }
      }
      return result;
    }

    /// The eigenvalues, which are simple: all zeros of the characteristic polynomial at once (Weierstrass). The real
    /// one first, then pairs with falling imaginary parts, in each pair the positive one first.
    std::vector<Complex>
    eigenvalues_of(const Matrix<Real> &matrix)
    {
      // Faddeev and LeVerrier: x^n + c[0] x^{n-1} + ... + c[n-1]
      const unsigned int n = matrix.n;
      std::vector<Real> c;
      Matrix<Real> m(n);
      for (unsigned int k = 1; k <= n; ++k)
      {
        Matrix<Real> product(n);
        Real trace = 0;
        for (unsigned int i = 0; i < n; ++i)
          m(i, i) += k == 1 ? 1 : c.back();
        for (unsigned int i = 0; i < n; ++i)
          for (unsigned int j = 0; j < n; ++j)
            for (unsigned int l = 0; l < n; ++l)
              product(i, j) += matrix(i, l) * m(l, j);
        for (unsigned int i = 0; i < n; ++i)
          trace += product(i, i);
        c.push_back(-trace / k);
        m.entries = product.entries;
      }
      std::vector<Complex> zeros;
      Real size = 0;
      for (unsigned int k = 0; k < n; ++k)
        size = std::max(size, std::pow(std::abs(c[k]), Real(1) / (k + 1)));
      for (unsigned int k = 0; k < n; ++k)
        zeros.push_back(std::polar(size, Real(2.5) * k + Real(0.4)));
      for (int iteration = 0; iteration < 200; ++iteration)
        for (unsigned int k = 0; k < n; ++k)
        {
          Complex value = 1, others = 1;
          for (unsigned int i = 0; i < n; ++i)
          {
            value = value * zeros[k] + c[i];
            if (i != k)
              others *= zeros[k] - zeros[i];
          }
          zeros[k] -= value / others;
        }
      std::ranges::sort(zeros, {}, [](const Complex &zero) {
        constexpr Real round_off = 1e-8L;
        const Real imaginary     = std::abs(zero.imag());
        return std::tuple(imaginary > round_off, -std::round(imaginary / round_off), -zero.imag());
      });
      zeros[0] = zeros[0].real();
      return zeros;
    }

    /// The Radau points in (0, 1]: the zeros of P_s - P_{s-1}, one in each grid interval where the sign changes.
    std::vector<double>
    radau_points(const unsigned int n)
    {
      const auto function = [n](const double x) {
        return boost::math::legendre_p(static_cast<int>(n), 2. * x - 1.) -
               boost::math::legendre_p(static_cast<int>(n) - 1, 2. * x - 1.);
      };
      std::vector<double> points;
      constexpr int n_grid = 1000;
      for (int i = 1; i < n_grid - 1; ++i)
      {
        const double left = (i - 0.5) / n_grid, right = (i + 0.5) / n_grid;
        if (function(left) * function(right) <= 0.)
          points.push_back(bracketed_root(function, left, right));
      }
      points.push_back(1.);
      return points;
    }

    /// Coefficients of 1, x, x^2, ... of the polynomial l_j with l_j(c_i) = (i == j).
    std::vector<Real>
    lagrange_polynomial(const std::vector<double> &c, const unsigned int j)
    {
      std::vector<Real> polynomial = {1};
      for (unsigned int k = 0; k < c.size(); ++k)
      {
        if (k == j)
          continue;
        std::vector<Real> product(polynomial.size() + 1, 0);
        for (unsigned int i = 0; i < polynomial.size(); ++i)
        {
          product[i] -= c[k] * polynomial[i] / (Real(c[j]) - c[k]);
          product[i + 1] += polynomial[i] / (Real(c[j]) - c[k]);
        }
        polynomial = product;
      }
      return polynomial;
    }

    Real
    integral(const std::vector<Real> &polynomial, const Real to)
    {
      Real sum = 0;
      for (std::size_t i = polynomial.size(); i-- > 0;)
        sum = sum * to + polynomial[i] / static_cast<Real>(i + 1);
      return sum * to;
    }

    /// The eigenvector whose last component is 1.
    std::vector<Complex>
    eigenvector(const Matrix<Real> &matrix, const Complex eigenvalue)
    {
      const unsigned int n = matrix.n - 1;
      Matrix<Complex> shifted(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          shifted(i, j) = matrix(i, j) - (i == j ? eigenvalue : Complex(0));
      const Matrix<Complex> inverse = inverse_of(shifted);
      std::vector<Complex> vector(n + 1, 0);
      vector[n] = 1;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          vector[i] -= inverse(i, j) * matrix(j, n);
      return vector;
    }
  } // namespace

  RadauTableau::RadauTableau(const unsigned int n_stages)
    : n(n_stages)
    , newton_fraction(n_stages == 5 ? 1e-4 : 1e-3)
    , c(radau_points(n_stages))
    , inverse(static_cast<std::size_t>(n_stages) * n_stages)
    , error_weights(n_stages, 0.)
  {
    Matrix<Real> A(n);
    for (unsigned int j = 0; j < n; ++j)
    {
      const auto polynomial = lagrange_polynomial(c, j);
      for (unsigned int i = 0; i < n; ++i)
        A(i, j) = integral(polynomial, c[i]);
    }
    for (unsigned int j = 0; j < n; ++j)
      b.push_back(static_cast<double>(A(n - 1, j)));
    const Matrix<Real> W = inverse_of(A);
    std::ranges::transform(W.entries, inverse.begin(), [](const Real x) { return static_cast<double>(x); });

    const std::vector<Complex> zeros = eigenvalues_of(W);
    Matrix<Complex> right(n);
    for (unsigned int k = 0; k < n; ++k)
    {
      const auto vector = eigenvector(W, zeros[k]);
      for (unsigned int i = 0; i < n; ++i)
        right(i, k) = vector[i];
    }
    const Matrix<Complex> left     = inverse_of(right);
    const auto rounded             = [](const Complex z) { return std::complex<double>(z); };
    real_eigenvalue                = static_cast<double>(zeros[0].real());
    std::vector<unsigned int> kept = {0};
    for (unsigned int k = 1; k < n; k += 2)
    {
      kept.push_back(k);
      eigenvalues.push_back(rounded(zeros[k]));
    }
    for (unsigned int i = 0; i < n; ++i)
      for (const unsigned int k : kept)
        vectors.push_back(rounded(right(i, k)));
    for (const unsigned int k : kept)
      for (unsigned int j = 0; j < n; ++j)
        rows.push_back(rounded(left(k, j)));

    // The weights b^ integrate polynomials up to degree s-1 exactly together with the weight gamma_0 of f(0), so with
    // l_j: b^_j = b_j - gamma_0 l_j(0).
    const double gamma_0 = 1. / real_eigenvalue;
    for (unsigned int j = 0; j < n; ++j)
    {
      const double at_start = static_cast<double>(lagrange_polynomial(c, j)[0]);
      for (unsigned int l = 0; l < n; ++l)
        error_weights[l] -= gamma_0 * at_start * inverse[j * n + l];
    }
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
