// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/mesh_transfer.h>
#include <crawler/mesh/reference_element.h>

#include <cmath>
#include <map>

namespace crawler
{
  namespace
  {
    std::vector<double>
    half(std::vector<double> places, const unsigned int which)
    {
      for (double &x : places)
        x = 0.5 * (x + which);
      return places;
    }

    /// Product y = matrix x, both of one cell.
    void
    apply(const std::vector<double> &matrix,
          const double *x,
          const unsigned int columns,
          double *y,
          const unsigned int rows)
    {
      for (unsigned int i = 0; i < rows; ++i)
      {
        double sum = 0.;
        for (unsigned int j = 0; j < columns; ++j)
          sum += matrix[i * columns + j] * x[j];
        y[i] = sum;
      }
    }

    /// Integral of u over the whole mesh.
    double
    integral(const std::vector<double> &u, const std::vector<Cell> &cells, const ReferenceElement &element)
    {
      double sum = 0.;
      for (std::size_t c = 0; c < cells.size(); ++c)
        for (unsigned int i = 0; i < element.n; ++i)
          sum += cells[c].size * element.node_weights[i] * u[c * element.degree + i];
      return sum;
    }

    /// Matrices that carry the displacements of a cell over.
    struct Matrices
    {
      explicit Matrices(const ReferenceElement &element)
      {
        const unsigned int n = element.n, q = element.degree;
        for (const unsigned int which : {0u, 1u})
          to_half[which] = interpolation_matrix(element.nodes, half(element.nodes, which));

        // Joining: Legendre coefficients of the stretch over the whole cell.
        to_joined.assign(n * (2 * q + 1), 0.);
        for (unsigned int i = 0; i < n; ++i)
          to_joined[i * (2 * q + 1)] = 1.; // u at the left end, plus the integral of the stretch
        for (unsigned int k = 0; k < q; ++k)
          for (const unsigned int which : {0u, 1u})
            for (unsigned int p = 0; p < n; ++p)
            {
              const double x           = 0.5 * (element.points[p] + which);
              const double coefficient = (2. * k + 1.) * 0.5 * element.weights[p] * std::legendre(k, 2. * x - 1.);
              for (unsigned int i = 0; i < n; ++i)
                for (unsigned int j = 0; j < n; ++j)
                  to_joined[i * (2 * q + 1) + which * q + j] +=
                    integrated_legendre(k, element.nodes[i]) * coefficient * 2. * element.derivatives[p * n + j];
            }
      }

      std::vector<double> to_half[2]; ///< [n][n] from a cell's nodes to those of its left and right half
      std::vector<double> to_joined;  ///< [n][2q+1] from the nodes of two halves to those of the cell
    };
  } // namespace

  std::vector<double>
  transferred(const PositionForm &from, const std::span<const double> y, const PositionForm &to)
  {
    const ReferenceElement &element = to.discretization.element;
    static std::map<unsigned int, const Matrices> known;
    const Matrices &matrices = known.try_emplace(element.degree, element).first->second;
    const unsigned int n = element.n, q = element.degree;
    const auto &old_cells = from.discretization.cells, &new_cells = to.discretization.cells;
    const std::vector<double> u_old = from.discretization.gather(from.displacement(y));
    std::vector<double> u(new_cells.size() * q + 1);
    for (std::size_t c = 0, old = 0; c < new_cells.size();)
    {
      const double *u_of = &u_old[old * q];
      double *u_to       = &u[c * q];
      if (new_cells[c].level == old_cells[old].level)
      {
        std::copy(u_of, u_of + n, u_to);
        ++c;
        ++old;
      }
      else if (new_cells[c].level > old_cells[old].level)
      {
        for (const unsigned int which : {0u, 1u})
          apply(matrices.to_half[which], u_of, n, u_to + which * q, n);
        u_to[0]     = u_of[0];
        u_to[2 * q] = u_of[q];
        c += 2;
        ++old;
      }
      else
      {
        apply(matrices.to_joined, u_of, 2 * q + 1, u_to, n);
        u_to[0] = u_of[0];
        u_to[q] = u_of[2 * q];
        ++c;
        old += 2;
      }
    }
    const double missing =
      (integral(u_old, old_cells, element) - integral(u, new_cells, element)) / to.discretization.length;
    for (double &value : u)
      value += missing;
    const auto owned = to.discretization.owned_part(u);
    return {owned.begin(), owned.end()};
  }
} // namespace crawler
