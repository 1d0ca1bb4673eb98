// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/cell_kernels.h>
#include <crawler/equation/cell_loops.h>
#include <crawler/equation/crawler_equation.h>
#include <crawler/scene/friction_law.h>

#include <array>
#include <cmath>
#include <stdexcept>

namespace crawler
{
  using namespace CRAWLER_INSTRUCTION_SET;

  namespace
  {
    ElementTables
    tables_of(const ReferenceElement &element)
    {
      return {element.values.data(), element.derivatives.data(), element.weights.data(), element.stiffness.data()};
    }

    template <int q>
    struct Kernels
    {
      static constexpr int n = q + 1;
      using Points           = std::array<double, n>;

      /// g at the points of a cell.
      static auto
      friction_of(const CellInput &in)
      {
        return [&in](const double *w, double *g) { in.friction->values({w, n}, {g, n}); };
      }

      static long
      residual(const CellInput &in, double *F)
      {
        const ElementTables tables = tables_of(*in.element);
        const auto friction        = friction_of(in);
        long bad                   = -1;
        for (unsigned int c = 0; c < in.n_cells; ++c)
        {
          double w[n];
          const double *v = in.v != nullptr ? in.v + c * q : nullptr;
          cell_residual<n>(tables, in.cell_size[c], in.k, in.u + c * q, v, in.m + c * n, friction, w, F + c * q);
          for (int p = 0; p < n; ++p)
            if (!(w[p] > 0.) && bad < 0)
              bad = static_cast<long>(c) * n + p;
        }
        return bad;
      }

      static void
      jacobian(const CellInput &in, const double sigma, double *blocks)
      {
        const double *values = in.element->values.data(), *derivatives = in.element->derivatives.data();
        const double *weights = in.element->weights.data(), *stiffness = in.element->stiffness.data();
        for (unsigned int c = 0; c < in.n_cells; ++c)
        {
          const double h = in.cell_size[c], k_over_h = in.k / h;
          double *J = blocks + c * n * n;
          Points w, g, dg, v;
          evaluate<n>(derivatives, in.u + c * q, 1. / h, 1., w.data());
          evaluate<n>(values, in.v + c * q, 1., 0., v.data());
          in.friction->values_and_log_derivatives(w, g, dg);
          for (int i = 0; i < n * n; ++i)
            J[i] = k_over_h * stiffness[i];
          for (int p = 0; p < n; ++p)
          {
            const double from_v = h * weights[p] * sigma * g[p];
            const double from_w = weights[p] * dg[p] / w[p] * v[p]; // h * (1/h)
            Points column;
            for (int j = 0; j < n; ++j)
              column[j] = from_v * values[p * n + j] + from_w * derivatives[p * n + j];
            for (int i = 0; i < n; ++i)
              for (int j = 0; j < n; ++j)
                J[i * n + j] += values[p * n + i] * column[j];
          }
        }
      }

      static void
      mass(const CellInput &in, double *blocks)
      {
        for (unsigned int c = 0; c < in.n_cells; ++c)
          cell_mass<n>(tables_of(*in.element), in.cell_size[c], in.u + c * q, friction_of(in), blocks + c * n * n);
      }

      static void
      integrals(const CellInput &in, CellIntegrals &sum)
      {
        for (unsigned int c = 0; c < in.n_cells; ++c)
          cell_integrals<n>(tables_of(*in.element),
                            in.cell_size[c],
                            in.k,
                            in.u + c * q,
                            in.v + c * q,
                            in.m + c * n,
                            friction_of(in),
                            sum);
      }

      static constexpr CellKernels table = {residual, jacobian, mass, integrals};
    };
  } // namespace

  const CellKernels &
  cell_kernels(const unsigned int degree)
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
} // namespace crawler
