// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/gauss_rule.h>
#include <crawler/mesh/reference_element.h>

#include <map>
#include <stdexcept>

namespace crawler
{
  std::vector<double>
  interpolation_matrix(const std::vector<double> &nodes, const std::vector<double> &points, const bool derivative)
  {
    std::vector<double> matrix;
    for (const double x : points)
      for (std::size_t i = 0; i < nodes.size(); ++i)
      {
        double value = 1., slope = 0., scale = 1.;
        for (std::size_t j = 0; j < nodes.size(); ++j)
          if (j != i)
          {
            slope = slope * (x - nodes[j]) + value;
            value *= x - nodes[j];
            scale *= nodes[i] - nodes[j];
          }
        matrix.push_back((derivative ? slope : value) * (1. / scale));
      }
    return matrix;
  }

  namespace
  {
    /// Integrals from 0 to each of @p points of the Lagrange polynomials through @p nodes: [points][nodes].
    std::vector<double>
    integration_matrix(const std::vector<double> &nodes, const std::vector<double> &points)
    {
      const auto n               = static_cast<unsigned int>(nodes.size());
      const QuadratureRule gauss = gauss_rule(n);
      std::vector<double> matrix;
      for (const double end : points)
      {
        std::vector<double> x;
        for (unsigned int g = 0; g < n; ++g)
          x.push_back(end * gauss.points[g]);
        const std::vector<double> values = interpolation_matrix(nodes, x);
        for (unsigned int i = 0; i < n; ++i)
        {
          double sum = 0.;
          for (unsigned int g = 0; g < n; ++g)
            sum += end * gauss.weights[g] * values[g * n + i];
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
    if (degree < 1 || degree > highest_degree)
      throw std::logic_error("degrees 1 to 8 are compiled");
    const QuadratureRule lobatto = gauss_lobatto_rule(n), gauss = gauss_rule(n);
    nodes          = lobatto.points;
    node_weights   = lobatto.weights;
    points         = gauss.points;
    weights        = gauss.weights;
    stretch_points = gauss_rule(degree).points;
    values         = interpolation_matrix(nodes, points);
    derivatives    = interpolation_matrix(nodes, points, /*derivative=*/true);
    stiffness.assign(n * n, 0.);
    for (unsigned int p = 0; p < n; ++p)
      for (unsigned int i = 0; i < n; ++i)
        for (unsigned int j = 0; j < n; ++j)
          stiffness[i * n + j] += weights[p] * derivatives[p * n + i] * derivatives[p * n + j];

    stretch_derivatives = interpolation_matrix(nodes, stretch_points, /*derivative=*/true);
    integrate_points    = integration_matrix(points, points);
    sample_places       = {0., 1.};
    sample_places.insert(sample_places.begin() + 1, points.begin(), points.end());
    sample_derivatives = interpolation_matrix(nodes, sample_places, /*derivative=*/true);
  }

  const ReferenceElement &
  reference_element(const unsigned int degree)
  {
    static std::map<unsigned int, const ReferenceElement> elements;
    return elements.try_emplace(degree, degree).first->second;
  }
} // namespace crawler
