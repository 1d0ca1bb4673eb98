// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/discretization/cell_kernels.h>
#include <crawler/discretization/chain_kernels.h>
#include <crawler/model/crawler_equation.h>
#include <crawler/scene/friction_law.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    template <int q>
    struct Kernels
    {
      static constexpr int n = q + 1;
      using Nodes            = std::array<double, n>;
      using Points           = std::array<double, q>;

      // What the Jacobian keeps of a cell. With x the change of (log w)_p and v that of the nodes:
      //   L row:  diagonal_p x_p - row_p sum_j D_pj v_j
      //   F row:  sum_p ( column_node_i E_ip + column_point_p D_pi ) x_p + mass_i v_i
      template <typename Number>
      struct Factors
      {
        Number diagonal[q];
        double row[q], column_point[q], column_node[n], mass[n];
      };
      static_assert(sizeof(Factors<double>) == log_factors<double>(q) * sizeof(double));
      static_assert(sizeof(Factors<std::complex<double>>) == log_factors<std::complex<double>>(q) * sizeof(double));

      /// The friction at the nodes of cell c.
      static void
      friction_at_nodes(const LogCellInput &in, const unsigned int c, Nodes &g)
      {
        Nodes w_dg;
        friction_at_nodes(in, c, g, w_dg);
      }

      /// The same, and h times the node's weight times w_dg is the derivative of the node's friction (that of both of
      /// its cells) with respect to log w of this cell, continued to the node.
      static void
      friction_at_nodes(const LogCellInput &in, const unsigned int c, Nodes &g, Nodes &w_dg)
      {
        const CellInput &cells = in.cells;
        if constexpr (q == 1)
        {
          const double log_w = in.log_w[c], w = std::exp(log_w), h = cells.cell_size[c];
          double own = 0., own_dg = 0.;
          cells.friction->values_and_log_derivatives({&w, 1}, {&own, 1}, {&own_dg, 1});
          g.fill(own);
          w_dg.fill(own_dg);
          for (unsigned int i = 0; i < 2; ++i)
          {
            const bool last      = i == 0 ? c == 0 : c + 1 == cells.n_cells;
            const unsigned int b = i == 0 ? c - 1 : c + 1;
            const LogCellInput::Beside other =
              last ? in.beside[i] : LogCellInput::Beside{cells.cell_size[b], in.log_w[b]};
            // A node that moves to the right takes length from the cell on its right.
            const double slope = (i == 0 ? -1. : 1.) * (other.log_w - log_w);
            if (other.size == 0. || slope * cells.v[c + i] <= 0.)
              continue;
            const double other_w = std::exp(other.log_w);
            double other_g       = 0.;
            cells.friction->values({&other_w, 1}, {&other_g, 1});
            const double part = 2. / (1. + own / other_g);
            g[i]              = part * own;
            w_dg[i]           = 0.5 * (1. + other.size / h) * part * part * own_dg;
          }
        }
        else
        {
          // The polynomial through log w, continued to the ends of the cell.
          Nodes w;
          for (int i = 0; i < n; ++i)
          {
            double sum = 0.;
            for (int p = 0; p < q; ++p)
              sum += cells.element->stretch_to_nodes[i * q + p] * in.log_w[c * q + p];
            w[i] = std::exp(sum);
          }
          cells.friction->values_and_log_derivatives(w, g, w_dg);
        }
      }

      /// v_s at the stretch points.
      template <typename Number>
      static void
      rates(const double *D, const Number *v, const double inverse_h, std::array<Number, q> &v_s)
      {
        for (int p = 0; p < q; ++p)
        {
          Number sum = 0.;
          for (int i = 0; i < n; ++i)
            sum += D[p * n + i] * v[i];
          v_s[p] = inverse_h * sum;
        }
      }

      static void
      residual(const LogCellInput &in, double *F, double *L)
      {
        const CellInput &cells    = in.cells;
        const ReferenceElement &e = *cells.element;
        const double *D           = e.stretch_derivatives.data();
        const bool with_friction  = in.log_w_dot != nullptr;
        for (unsigned int c = 0; c < cells.n_cells; ++c)
        {
          const double h      = cells.cell_size[c];
          const double *log_w = in.log_w + c * q, *m = cells.m + c * q;
          double *f = F + c * q;
          if (with_friction)
          {
            const double *v = cells.v + c * q;
            Nodes g;
            friction_at_nodes(in, c, g);
            for (int i = 0; i < n; ++i)
              f[i] += h * e.node_weights[i] * equation::friction_force(g[i], v[i]);
            Points v_s;
            rates(D, v, 1. / h, v_s);
            for (int p = 0; p < q; ++p)
              L[c * q + p] = in.log_w_dot[c * q + p] - v_s[p] * std::exp(-log_w[p]);
          }
          for (int p = 0; p < q; ++p)
          {
            const double force = e.stretch_weights[p] * equation::body_force(std::expm1(log_w[p]), m[p], cells.k);
            for (int i = 0; i < n; ++i)
              f[i] += force * D[p * n + i];
          }
        }
      }

      static void
      mass(const LogCellInput &in, double *M)
      {
        const ReferenceElement &e = *in.cells.element;
        for (unsigned int c = 0; c < in.cells.n_cells; ++c)
        {
          Nodes g;
          friction_at_nodes(in, c, g);
          for (int i = 0; i < n; ++i)
            M[c * q + i] += in.cells.cell_size[c] * e.node_weights[i] * g[i];
        }
      }

      static void
      friction(const LogCellInput &in, double *g, double *w_dg)
      {
        for (unsigned int c = 0; c < in.cells.n_cells; ++c)
        {
          Nodes at_nodes, derivatives;
          friction_at_nodes(in, c, at_nodes, derivatives);
          std::copy(at_nodes.begin(), at_nodes.end(), g + c * n);
          std::copy(derivatives.begin(), derivatives.end(), w_dg + c * n);
        }
      }

      /// The blocks of cell c from its factors.
      template <typename Number>
      static void
      eliminate(const ReferenceElement &e, const Factors<Number> &f, Number *J)
      {
        const double *D = e.stretch_derivatives.data(), *E = e.stretch_to_nodes.data();
        for (int i = 0; i < n; ++i)
        {
          Number column[q];
          for (int p = 0; p < q; ++p)
            column[p] = (f.column_node[i] * E[i * q + p] + f.column_point[p] * D[p * n + i]) * f.row[p] / f.diagonal[p];
          for (int j = 0; j < n; ++j)
          {
            Number sum = i == j ? f.mass[i] : 0.;
            for (int p = 0; p < q; ++p)
              sum += column[p] * D[p * n + j];
            J[i * n + j] = sum;
          }
        }
      }

      template <typename Number>
      static bool
      jacobian(const LogCellInput &in, const Number sigma, Number *blocks, double *factors)
      {
        const CellInput &cells    = in.cells;
        const ReferenceElement &e = *cells.element;
        bool ok                   = true;
        for (unsigned int c = 0; c < cells.n_cells; ++c)
        {
          const double h      = cells.cell_size[c];
          const double *log_w = in.log_w + c * q, *v = cells.v + c * q;
          Nodes g, w_dg;
          friction_at_nodes(in, c, g, w_dg);
          Points v_s;
          rates(e.stretch_derivatives.data(), v, 1. / h, v_s);
          auto &f = reinterpret_cast<Factors<Number> *>(factors)[c];
          for (int i = 0; i < n; ++i)
          {
            f.mass[i]        = h * e.node_weights[i] * g[i];
            f.column_node[i] = h * e.node_weights[i] * w_dg[i] * v[i];
          }
          for (int p = 0; p < q; ++p)
          {
            const double stretch = std::exp(log_w[p]);
            f.diagonal[p]        = sigma + v_s[p] / stretch;
            f.row[p]             = 1. / (h * stretch);
            f.column_point[p]    = e.stretch_weights[p] * cells.k * stretch;
            ok                   = ok && f.diagonal[p] != 0. && is_finite(f.diagonal[p]);
          }
          eliminate(e, f, blocks + c * n * n);
        }
        return ok;
      }

      template <typename Number>
      static bool
      general_jacobian(const LogCellInput &in, const LogLaws &laws, const Number sigma, Number *blocks, double *factors)
      {
        const CellInput &cells    = in.cells;
        const ReferenceElement &e = *cells.element;
        const double *D           = e.stretch_derivatives.data();
        bool ok                   = true;
        for (unsigned int c = 0; c < cells.n_cells; ++c)
        {
          const double h = cells.cell_size[c];
          Points v_s;
          rates(D, cells.v + c * q, 1. / h, v_s);
          auto &f = reinterpret_cast<Factors<Number> *>(factors)[c];
          for (int i = 0; i < n; ++i)
          {
            f.mass[i]        = h * e.node_weights[i] * laws.by_v[c * n + i];
            f.column_node[i] = h * e.node_weights[i] * laws.by_log_w[c * n + i];
          }
          for (int p = 0; p < q; ++p)
          {
            const double stretch = std::exp(in.log_w[c * q + p]);
            f.diagonal[p]        = sigma + v_s[p] / stretch;
            f.row[p]             = 1. / (h * stretch);
            f.column_point[p]    = e.stretch_weights[p] * laws.by_log[c * q + p];
            ok                   = ok && f.diagonal[p] != 0. && is_finite(f.diagonal[p]);
          }
          Number *J = blocks + c * n * n;
          eliminate(e, f, J);
          if (laws.by_rate.empty())
            continue;
          for (int p = 0; p < q; ++p)
            for (int i = 0; i < n; ++i)
              for (int j = 0; j < n; ++j)
                J[i * n + j] += e.stretch_weights[p] / h * laws.by_rate[c * q + p] * D[p * n + i] * D[p * n + j];
        }
        return ok;
      }

      template <typename Number>
      static void
      reduce(const CellInput &cells, const double *factors, const Number *l, Number *F)
      {
        const double *D = cells.element->stretch_derivatives.data(), *E = cells.element->stretch_to_nodes.data();
        for (unsigned int c = 0; c < cells.n_cells; ++c)
        {
          const auto &f = reinterpret_cast<const Factors<Number> *>(factors)[c];
          for (int p = 0; p < q; ++p)
          {
            const Number x = l[c * q + p] / f.diagonal[p];
            for (int i = 0; i < n; ++i)
              F[c * q + i] -= (f.column_node[i] * E[i * q + p] + f.column_point[p] * D[p * n + i]) * x;
          }
        }
      }

      template <typename Number>
      static void
      recover(const CellInput &cells, const double *factors, const Number *v, Number *l)
      {
        const double *D = cells.element->stretch_derivatives.data();
        for (unsigned int c = 0; c < cells.n_cells; ++c)
        {
          const auto &f = reinterpret_cast<const Factors<Number> *>(factors)[c];
          std::array<Number, q> v_s;
          rates(D, v + c * q, 1., v_s);
          for (int p = 0; p < q; ++p)
            l[c * q + p] = (l[c * q + p] + f.row[p] * v_s[p]) / f.diagonal[p];
        }
      }

      static void
      multiply(const CellInput &cells, const double *factors, const double *v, const double *x, double *F, double *l)
      {
        const double *D = cells.element->stretch_derivatives.data(), *E = cells.element->stretch_to_nodes.data();
        for (unsigned int c = 0; c < cells.n_cells; ++c)
        {
          const auto &f = reinterpret_cast<const Factors<double> *>(factors)[c];
          Points v_s;
          rates(D, v + c * q, 1., v_s);
          for (int i = 0; i < n; ++i)
            F[c * q + i] += f.mass[i] * v[c * q + i];
          for (int p = 0; p < q; ++p)
          {
            l[c * q + p] += f.diagonal[p] * x[c * q + p] - f.row[p] * v_s[p];
            for (int i = 0; i < n; ++i)
              F[c * q + i] += (f.column_node[i] * E[i * q + p] + f.column_point[p] * D[p * n + i]) * x[c * q + p];
          }
        }
      }

      static void
      integrals(const LogCellInput &in, CellIntegrals &sum)
      {
        const CellInput &cells    = in.cells;
        const ReferenceElement &e = *cells.element;
        for (unsigned int c = 0; c < cells.n_cells; ++c)
        {
          const double h  = cells.cell_size[c];
          const double *u = cells.u + c * q, *v = cells.v + c * q;
          Nodes g;
          friction_at_nodes(in, c, g);
          for (int i = 0; i < n; ++i)
          {
            const double ds = h * e.node_weights[i], friction = equation::friction_force(g[i], v[i]);
            sum.displacement += ds * u[i];
            sum.velocity += ds * v[i];
            sum.dissipation += ds * equation::dissipation(g[i], v[i]);
            sum.net_friction += ds * friction;
            sum.abs_friction += ds * std::abs(friction);
          }
          Points v_s;
          rates(e.stretch_derivatives.data(), v, 1. / h, v_s);
          for (int p = 0; p < q; ++p)
          {
            const double ds = h * e.stretch_weights[p], power = equation::stress_power(cells.m[c * q + p], v_s[p]);
            sum.elastic_energy += ds * equation::elastic_energy(std::expm1(in.log_w[c * q + p]), cells.k);
            sum.stress_power += ds * power;
            sum.positive_power += ds * std::max(power, 0.);
            sum.absolute_power += ds * std::abs(power);
          }
        }
      }

      static constexpr LogCellKernels table = {residual, mass, friction, multiply, integrals};
      template <typename Number>
      static constexpr LogElimination<Number> elimination = {
        jacobian<Number>, general_jacobian<Number>, reduce<Number>, recover<Number>};
    };
  } // namespace

  const LogCellKernels &
  log_cell_kernels(const unsigned int degree)
  {
    switch (degree)
    {
      case 1:
        return Kernels<1>::table;
      case 2:
        return Kernels<2>::table;
      case 3:
        return Kernels<3>::table;
      case 4:
        return Kernels<4>::table;
      case 5:
        return Kernels<5>::table;
      case 6:
        return Kernels<6>::table;
      case 7:
        return Kernels<7>::table;
      case 8:
        return Kernels<8>::table;
    }
    throw std::logic_error("degrees 1 to 8 are compiled");
  }

  template <typename Number>
  const LogElimination<Number> &
  log_elimination(const unsigned int degree)
  {
    switch (degree)
    {
      case 1:
        return Kernels<1>::template elimination<Number>;
      case 2:
        return Kernels<2>::template elimination<Number>;
      case 3:
        return Kernels<3>::template elimination<Number>;
      case 4:
        return Kernels<4>::template elimination<Number>;
      case 5:
        return Kernels<5>::template elimination<Number>;
      case 6:
        return Kernels<6>::template elimination<Number>;
      case 7:
        return Kernels<7>::template elimination<Number>;
      case 8:
        return Kernels<8>::template elimination<Number>;
    }
    throw std::logic_error("degrees 1 to 8 are compiled");
  }

  template const LogElimination<double> &
  log_elimination(unsigned int);
  template const LogElimination<std::complex<double>> &
  log_elimination(unsigned int);
} // namespace crawler
