// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/mesh/element_tables.h>

#include <type_traits>
#include <vector>

namespace crawler
{
  /**
   * Tables of the Lagrange element of degree q on the Gauss-Lobatto nodes of [0,1] (deal.II's FE_Q, nodes from left to
   * right) and of the Gauss formula with q + 1 points. Cells of a line are affine, so integration needs only these
   * numbers and a cell's size; FEValues is not in the hot path.
   */
  struct ReferenceElement
  {
    static constexpr unsigned int highest_degree = 8;

    /// Throws std::logic_error unless @p degree is 1 to highest_degree.
    explicit ReferenceElement(unsigned int degree);

    unsigned int degree;
    unsigned int n;                  ///< degree + 1: number of nodes, and of quadrature points
    std::vector<double> nodes;       ///< [n]
    std::vector<double> points;      ///< [n] quadrature points
    std::vector<double> weights;     ///< [n] quadrature weights, their sum is 1
    std::vector<double> values;      ///< [n points][n nodes] shape functions
    std::vector<double> derivatives; ///< [n points][n nodes] their derivatives
    std::vector<double> stiffness;   ///< [n nodes][n nodes] sum of weight derivative derivative

    // Gauss points that determine the stretch, a polynomial of degree q - 1.
    std::vector<double> node_weights;        ///< [n] Gauss-Lobatto weights of the nodes
    std::vector<double> stretch_points;      ///< [q] Gauss points of the stretch
    std::vector<double> stretch_derivatives; ///< [q stretch points][n nodes] derivatives of the shape functions

    // Samples of the stretch: at the ends of the cell, and at the quadrature points in between.
    std::vector<double> sample_places;      ///< [n + 2]
    std::vector<double> sample_derivatives; ///< [n + 2][n nodes] derivatives of the shape functions

    /// [n points][n] integrals from the left end of the cell to each quadrature point, of the polynomial through values
    /// at the quadrature points.
    std::vector<double> integrate_points;

    ElementTables
    tables() const
    {
      return {values.data(), derivatives.data(), weights.data(), stiffness.data()};
    }
  };

  /// Result of @p use for a degree, 1 to highest_degree, as a constant of the compiler: std::integral_constant<int, q>.
  template <unsigned int q = 1, typename Use>
  decltype(auto)
  for_degree(const unsigned int degree, const Use &use)
  {
    if constexpr (q < ReferenceElement::highest_degree)
      if (degree > q)
        return for_degree<q + 1>(degree, use);
    return use(std::integral_constant<int, q>());
  }

  /// Returns the tables of a degree, made on first use and kept: meshes change more often.
  const ReferenceElement &
  reference_element(unsigned int degree);

  /// Integral from 0 to @p x of the Legendre polynomial P_k(2 x - 1).
  double
  integrated_legendre(unsigned int k, double x);

  /// Values of the Lagrange polynomials through @p nodes, or of their derivatives, at @p points: [points][nodes].
  std::vector<double>
  interpolation_matrix(const std::vector<double> &nodes, const std::vector<double> &points, bool derivative = false);
} // namespace crawler
