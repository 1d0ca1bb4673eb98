// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/reference_element.h>

#include <deal.II/base/polynomial.h>
#include <deal.II/base/quadrature_lib.h>

namespace crawler
{
  ReferenceElement::ReferenceElement(const unsigned int degree)
    : degree(degree)
    , n(degree + 1)
  {
    const dealii::QGaussLobatto<1> lobatto(n);
    const dealii::QGauss<1> gauss(n);
    const auto shape = dealii::Polynomials::generate_complete_Lagrange_basis(lobatto.get_points());

    std::vector<double> value_and_derivative(2);
    for (unsigned int i = 0; i < n; ++i)
    {
      nodes.push_back(lobatto.point(i)[0]);
      points.push_back(gauss.point(i)[0]);
      weights.push_back(gauss.weight(i));
    }
    for (unsigned int p = 0; p < n; ++p)
      for (unsigned int i = 0; i < n; ++i)
      {
        shape[i].value(points[p], value_and_derivative);
        values.push_back(value_and_derivative[0]);
        derivatives.push_back(value_and_derivative[1]);
      }
    for (unsigned int i = 0; i < n; ++i)
    {
      shape[i].value(0., value_and_derivative);
      left_derivatives.push_back(value_and_derivative[1]);
      shape[i].value(1., value_and_derivative);
      right_derivatives.push_back(value_and_derivative[1]);
    }
    stiffness.assign(n * n, 0.);
    for (unsigned int p = 0; p < n; ++p)
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          stiffness[i * n + j] += weights[p] * derivatives[p * n + i] * derivatives[p * n + j];
  }
} // namespace crawler
