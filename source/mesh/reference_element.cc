// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/mesh/reference_element.h>

#include <deal.II/base/polynomial.h>
#include <deal.II/base/quadrature_lib.h>

#include <map>

namespace crawler
{
  std::vector<double>
  interpolation_matrix(const std::vector<double> &nodes,
                       const std::vector<double> &points,
                       const unsigned int derivative)
  {
    std::vector<dealii::Point<1>> support(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i)
      support[i][0] = nodes[i];
    const auto basis = dealii::Polynomials::generate_complete_Lagrange_basis(support);
    std::vector<double> matrix, values(derivative + 1);
    for (const double x : points)
      for (const auto &polynomial : basis)
      {
        polynomial.value(x, values);
        matrix.push_back(values[derivative]);
      }
    return matrix;
  }

  namespace
  {
    /// Integrals from 0 to each of @p points of the Lagrange polynomials through @p nodes: [points][nodes].
    std::vector<double>
    integration_matrix(const std::vector<double> &nodes, const std::vector<double> &points)
    {
      const auto n = static_cast<unsigned int>(nodes.size());
      const dealii::QGauss<1> gauss(n);
      std::vector<double> matrix;
      for (const double end : points)
      {
        std::vector<double> x;
        for (unsigned int g = 0; g < n; ++g)
          x.push_back(end * gauss.point(g)[0]);
        const std::vector<double> values = interpolation_matrix(nodes, x);
        for (unsigned int i = 0; i < n; ++i)
        {
          double sum = 0.;
          for (unsigned int g = 0; g < n; ++g)
            sum += end * gauss.weight(g) * values[g * n + i];
          matrix.push_back(sum);
        }
      }
      return matrix;
    }
  } // namespace

  ReferenceElement::ReferenceElement(const unsigned int degree)
    : degree(degree)
    , n(degree + 1)
  {
    const dealii::QGaussLobatto<1> lobatto(n);
    const dealii::QGauss<1> gauss(n);
    for (unsigned int i = 0; i < n; ++i)
    {
      nodes.push_back(lobatto.point(i)[0]);
      node_weights.push_back(lobatto.weight(i));
      points.push_back(gauss.point(i)[0]);
      weights.push_back(gauss.weight(i));
    }
    values            = interpolation_matrix(nodes, points);
    derivatives       = interpolation_matrix(nodes, points, 1);
    left_derivatives  = interpolation_matrix(nodes, {0.}, 1);
    right_derivatives = interpolation_matrix(nodes, {1.}, 1);
    stiffness.assign(n * n, 0.);
    for (unsigned int p = 0; p < n; ++p)
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          stiffness[i * n + j] += weights[p] * derivatives[p * n + i] * derivatives[p * n + j];

    const dealii::QGauss<1> stretch_gauss(degree);
    for (unsigned int p = 0; p < degree; ++p)
    {
      stretch_points.push_back(stretch_gauss.point(p)[0]);
      stretch_weights.push_back(stretch_gauss.weight(p));
    }
    stretch_derivatives = interpolation_matrix(nodes, stretch_points, 1);
    integrate_points    = integration_matrix(points, points);
  }

  const ReferenceElement &
  reference_element(const unsigned int degree)
  {
    static std::map<unsigned int, const ReferenceElement> elements;
    return elements.try_emplace(degree, degree).first->second;
  }
} // namespace crawler
