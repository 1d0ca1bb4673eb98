// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/gauss_rule.h>
#include <crawler/mesh/reference_element.h>

#include <cmath>
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

  double
  integrated_legendre(const unsigned int k, const double x)
  {
    const double z = 2. * x - 1.;
    return k == 0 ? x : (std::legendre(k + 1, z) - std::legendre(k - 1, z)) / (2. * (2. * k + 1.));
  }

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
    sample_places       = {0., 1.};
    sample_places.insert(sample_places.begin() + 1, points.begin(), points.end());
    sample_derivatives = interpolation_matrix(nodes, sample_places, /*derivative=*/true);
    for (const double end : points)
      for (unsigned int j = 0; j < n; ++j)
      {
        double &sum = integrate_points.emplace_back(0.);
        for (unsigned int k = 0; k < n; ++k) // Gauss's rule gives the Legendre series of a Lagrange polynomial exactly
          sum += (2. * k + 1.) * weights[j] * std::legendre(k, 2. * points[j] - 1.) * integrated_legendre(k, end);
      }
  }

  const ReferenceElement &
  reference_element(const unsigned int degree)
  {
    static std::map<unsigned int, const ReferenceElement> elements;
    return elements.try_emplace(degree, degree).first->second;
  }
} // namespace crawler
