// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/time/radau_tableau.h>

#include <deal.II/lac/full_matrix.h>
#include <deal.II/lac/lapack_full_matrix.h>

#include <boost/math/special_functions/legendre.hpp>
#include <boost/math/tools/toms748_solve.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    using Complex = std::complex<double>;

    /// The Radau points in (0, 1]: the zeros of P_s - P_{s-1}, between whose sign changes on a grid there is one each.
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
        if (function(left) * function(right) > 0.)
          continue;
        std::uintmax_t iterations = 100;
        const auto bracket        = boost::math::tools::toms748_solve(
          function, left, right, boost::math::tools::eps_tolerance<double>(52), iterations);
        points.push_back(0.5 * (bracket.first + bracket.second));
      }
      points.push_back(1.);
      return points;
    }

    /// The polynomial l_j with l_j(c_i) = (i == j), as its coefficients of 1, x, x^2, ...
    std::vector<double>
    lagrange_polynomial(const std::vector<double> &c, const unsigned int j)
    {
      std::vector<double> polynomial = {1.};
      for (unsigned int k = 0; k < c.size(); ++k)
      {
        if (k == j)
          continue;
        std::vector<double> product(polynomial.size() + 1, 0.);
        for (unsigned int i = 0; i < polynomial.size(); ++i)
        {
          product[i] -= c[k] * polynomial[i] / (c[j] - c[k]);
          product[i + 1] += polynomial[i] / (c[j] - c[k]);
        }
        polynomial = product;
      }
      return polynomial;
    }

    double
    integral(const std::vector<double> &polynomial, const double to)
    {
      double sum = 0.;
      for (std::size_t i = polynomial.size(); i-- > 0;)
        sum = sum * to + polynomial[i] / static_cast<double>(i + 1);
      return sum * to;
    }

    /// The eigenvector whose last component is 1.
    std::vector<Complex>
    eigenvector(const dealii::FullMatrix<double> &matrix, const Complex eigenvalue)
    {
      const unsigned int n = matrix.m() - 1;
      dealii::FullMatrix<Complex> shifted(n);
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          shifted(i, j) = matrix(i, j) - (i == j ? eigenvalue : 0.);
      shifted.gauss_jordan();
      std::vector<Complex> vector(n + 1, 0.);
      vector[n] = 1.;
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          vector[i] -= shifted(i, j) * matrix(j, n);
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
    dealii::FullMatrix<double> A(n), W(n);
    for (unsigned int j = 0; j < n; ++j)
    {
      const auto polynomial = lagrange_polynomial(c, j);
      for (unsigned int i = 0; i < n; ++i)
        A(i, j) = integral(polynomial, c[i]);
    }
    W.invert(A);
    for (unsigned int j = 0; j < n; ++j)
      b.push_back(A(n - 1, j));
    dealii::LAPACKFullMatrix<double> lapack(n);
    lapack = W;
    lapack.compute_eigenvalues();
    dealii::FullMatrix<Complex> right(n), left(n);
    for (unsigned int k = 0; k < n; ++k)
    {
      const auto vector = eigenvector(W, lapack.eigenvalue(k));
      for (unsigned int i = 0; i < n; ++i)
        right(i, k) = vector[i];
    }
    left.invert(right);

    std::vector<unsigned int> kept;
    for (unsigned int i = 0; i < n; ++i)
      if (std::abs(lapack.eigenvalue(i).imag()) < 1e-8)
        kept.insert(kept.begin(), i);
      else if (lapack.eigenvalue(i).imag() > 0.)
        kept.push_back(i);
    real_eigenvalue = lapack.eigenvalue(kept[0]).real();
    for (unsigned int i = 1; i < kept.size(); ++i)
      eigenvalues.push_back(lapack.eigenvalue(kept[i]));
    for (unsigned int i = 0; i < n; ++i)
      for (const unsigned int k : kept)
        vectors.push_back(right(i, k));
    for (const unsigned int k : kept)
      for (unsigned int j = 0; j < n; ++j)
        rows.push_back(left(k, j));
    for (unsigned int i = 0; i < n; ++i)
      for (unsigned int j = 0; j < n; ++j)
        inverse[i * n + j] = W(i, j);

    // b^ integrates polynomials up to degree s-1 exactly together with the weight gamma_0 of f(0), so with l_j:
    // b^_j = b_j - gamma_0 l_j(0).
    const double gamma_0 = 1. / real_eigenvalue;
    for (unsigned int j = 0; j < n; ++j)
      for (unsigned int l = 0; l < n; ++l)
        error_weights[l] -= gamma_0 * lagrange_polynomial(c, j)[0] * inverse[j * n + l];
  }

  const RadauTableau &
  radau_tableau(const unsigned int n_stages)
  {
    static const RadauTableau three(3), five(5), seven(7);
    if (n_stages != 3 && n_stages != 5 && n_stages != 7)
      throw std::logic_error("Radau IIA is there with 3, 5 and 7 stages");
    return n_stages == 3 ? three : n_stages == 5 ? five : seven;
  }
} // namespace crawler
