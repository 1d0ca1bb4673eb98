// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/equation/cell_kernels.h>
#include <crawler/equation/cell_laws.h>
#include <crawler/equation/cell_loops.h>
#include <crawler/scene/friction_law.h>

namespace crawler
{
  using namespace CRAWLER_INSTRUCTION_SET;

  namespace
  {
    template <int q>
    struct Kernels
    {
      static constexpr int n = q + 1;

      /// g at the points of a cell, and its derivative by log w.
      struct Friction
      {
        const FrictionLaw &law;

        void
        operator()(const double *w, double *g, double *w_dg = nullptr) const
        {
          law.values({w, n}, {g, n}, {w_dg, w_dg != nullptr ? n : 0u});
        }
      };
      using Plain = PlainLaws<n, double, Friction>;

      /// Calls @p use(laws, c) for each cell.
      template <typename Use>
      static void
      for_cells(const CellInput &in, const Use &use)
      {
        if (in.laws != nullptr)
          for (unsigned int c = 0; c < in.n_cells; ++c)
            use(KnownLaws<n, double>{*in.laws, static_cast<std::size_t>(c) * n}, c);
        else
          for (unsigned int c = 0; c < in.n_cells; ++c)
            use(Plain{in.k, in.m + c * n, {*in.friction}}, c);
      }

      static const double *
      velocity(const CellInput &in, const unsigned int c)
      {
        return in.v != nullptr ? in.v + c * q : nullptr;
      }

      [[gnu::flatten]] static long
      residual(const CellInput &in, double *F)
      {
        long bad = -1;
        for_cells(in, [&](const auto &laws, const unsigned int c) {
          const ElementTables tables = in.element->tables();
          const double h = in.cell_size[c], *v = velocity(in, c);
          double N[n], f[n];
          const auto at = cell_forces<n>(tables, h, laws, in.u + c * q, v, N, f);
          add_forces<n>(tables, h, N, v != nullptr ? f : nullptr, F + c * q);
          for (int p = 0; p < n; ++p)
            if (!(at.w[p] > 0.) && bad < 0)
              bad = static_cast<long>(c) * n + p;
        });
        return bad;
      }

      static void
      blocks(const CellInput &in, const double by_state, const double by_velocity, double *A)
      {
        const ElementTables tables = in.element->tables();
        for_cells(in, [&](const auto &laws, const unsigned int c) {
          double K[n * n], M[n * n], *block = A + c * n * n;
          const double *u = in.u + c * q, *v = velocity(in, c);
          if (by_state == 0.)
          {
            cell_blocks<n, false, double>(tables, in.cell_size[c], laws, u, v, nullptr, M);
            for (int i = 0; i < n * n; ++i)
              block[i] = by_velocity * M[i];
            return;
          }
          cell_blocks<n, true>(tables, in.cell_size[c], laws, u, v, K, M);
          for (int i = 0; i < n * n; ++i)
            block[i] = by_state * K[i] + by_velocity * M[i];
        });
      }

      static void
      integrals(const CellInput &in, CellIntegrals &sum)
      {
        for_cells(in, [&](const auto &laws, const unsigned int c) {
          const ElementTables tables = in.element->tables();
          const CellDensities<n, double> all(tables, in.cell_size[c], laws, in.u + c * q, in.v + c * q);
          for (int p = 0; p < n; ++p)
          {
            const double ds = in.cell_size[c] * tables.weights[p];
            sum.displacement += ds * all.u[p];
            add_densities(ds, all.at[p], all.v[p], sum);
          }
        });
      }

      static void
      forces(const CellInput &in, double *N, double *f)
      {
        for_cells(in, [&](const auto &laws, const unsigned int c) {
          cell_forces<n>(in.element->tables(), in.cell_size[c], laws, in.u + c * q, in.v + c * q, N + c * n, f + c * n);
        });
      }

      static void
      states(const CellInput &in, double *u, double *v, double *e, double *rate)
      {
        static constexpr double rest[n] = {};
        const ElementTables tables      = in.element->tables();
        for (unsigned int c = 0; c < in.n_cells; ++c)
        {
          const double *own_u = in.u + c * q, *own_v = in.v != nullptr ? in.v + c * q : rest;
          evaluate<n>(tables.values, own_u, 1., 0., u + c * n);
          evaluate<n>(tables.derivatives, own_u, 1. / in.cell_size[c], 0., e + c * n);
          evaluate<n>(tables.values, own_v, 1., 0., v + c * n);
          evaluate<n>(tables.derivatives, own_v, 1. / in.cell_size[c], 0., rate + c * n);
        }
      }

      static constexpr CellKernels table = {residual, blocks, integrals, forces, states};
    };
  } // namespace

  const CellKernels &
  cell_kernels(const unsigned int degree)
  {
    return for_degree(
      degree, [](const auto q) -> const auto & { return Kernels<q>::table; });
  }
} // namespace crawler
