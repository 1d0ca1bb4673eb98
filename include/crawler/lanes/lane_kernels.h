// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/cell_laws.h>
#include <crawler/lanes/lane_mesh.h>
#include <crawler/mesh/block_tridiagonal_loops.h>

/// Loops over all cells, for a pack of bodies and one degree q (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  template <typename Pack, int q>
  struct LaneKernels
  {
    static constexpr int n = q + 1;

    /// Friction at the points of a cell.
    struct CellFriction
    {
      const LaneFriction<Pack> &law;

      void
      operator()(const Pack *w, Pack *g) const
      {
        law(w, g, n);
      }

      void
      operator()(const Pack *w, Pack *g, Pack *w_dg) const
      {
        law(w, g, n);
        for (int p = 0; p < n; ++p)
          w_dg[p] = law.a * g[p];
      }
    };

    using Laws = PlainLaws<n, Pack, CellFriction>;

    /// Calls @p use(laws, c) for each cell.
    template <typename Use>
    [[gnu::always_inline]] static inline void
    for_cells(const LaneMesh<Pack> &mesh, const Pack *m, const Use &use)
    {
      if (mesh.laws != nullptr)
        for (int c = 0; c < mesh.n_cells; ++c)
          use(KnownLaws<n, Pack>{*mesh.laws, static_cast<std::size_t>(c) * n}, c);
      else
        for (int c = 0; c < mesh.n_cells; ++c)
          use(Laws{mesh.k, m != nullptr ? m + c * n : nullptr, {mesh.friction}}, c);
    }

    /// States for the laws of general bodies, at all points.
    [[gnu::flatten]] static void
    states(const LaneMesh<Pack> &mesh, const Pack *u, const Pack *v, const LaneStateAtPoints<Pack> &at)
    {
      for (int c = 0; c < mesh.n_cells; ++c)
        cell_states<n, Pack>(
          mesh.tables, mesh.sizes[c], u + c * q, v + c * q, at.u + c * n, at.v + c * n, at.e + c * n, at.rate + c * n);
    }

    /// Sets the nodes of cell @p c that no cell before it has to zero.
    static void
    set_to_zero(const int c, Pack *F)
    {
      if (c == 0)
        F[0] = Pack{};
      for (int i = 1; i < n; ++i)
        F[c * q + i] = Pack{};
    }

    /// Computes the residual: overwrites @p F; returns the smallest stretch at a quadrature point.
    [[gnu::flatten]] static Pack
    residual(const LaneMesh<Pack> &mesh, const Pack *u, const Pack *v, const Pack *m, Pack *F)
    {
      Pack least = broadcast<Pack>(HUGE_VAL);
      for_cells(mesh, m, [&](const auto &laws, const int c) {
        set_to_zero(c, F);
        const auto at = cell_residual<n, Pack>(mesh.tables, mesh.sizes[c], laws, u + c * q, v + c * q, F + c * q);
        for (int p = 0; p < n; ++p)
          least = smaller(at.w[p], least); // a stretch that is not a number makes F the same
      });
      return least;
    }

    /// Right-hand side of M x = F for the correction x of the velocity @p v to that in which all forces balance, and
    /// the factors of M. Without @p v, for plain bodies, x is the velocity.
    [[gnu::flatten]] static void
    balance(const LaneMesh<Pack> &mesh, const Pack *u, const Pack *v, const Pack *m, Pack *F, Pack *blocks, Pack *schur)
    {
      for_cells(mesh, m, [&](const auto &laws, const int c) {
        set_to_zero(c, F);
        const Pack *const own = v != nullptr ? v + c * q : nullptr;
        cell_residual<n, Pack>(mesh.tables, mesh.sizes[c], laws, u + c * q, own, F + c * q);
        cell_blocks<n, false, Pack>(mesh.tables, mesh.sizes[c], laws, u + c * q, own, nullptr, blocks + c * n * n);
        condense_cell<q>(blocks + c * n * n, schur + 4 * c, [](const auto &) {});
      });
      for (int i = 0; i <= mesh.n_cells * q; ++i)
        F[i] = -F[i];
    }

    [[gnu::flatten]] static void
    slopes(const LaneMesh<Pack> &mesh, const Pack *u, const Pack *v, const LaneSlopes<Pack> &at)
    {
      for_cells(mesh, nullptr, [&](const auto &laws, const int c) {
        const auto D = cell_derivatives<n, true, Pack>(mesh.tables, mesh.sizes[c], laws, u + c * q, v + c * q);
        for (int p = 0; p < n; ++p)
        {
          const int i = c * n + p;
          at.f_v[i]   = D.f_v[p];
          at.f_w[i]   = D.f_w[p];
          if constexpr (std::decay_t<decltype(laws)>::has_one_modulus)
            at.N_w[i] = laws.k;
          else
            at.N_w[i] = D.N_w[p];
          if (at.f_u != nullptr)
            at.f_u[i] = D.f_u[p];
          if (at.N_rate != nullptr)
            at.N_rate[i] = D.N_rate[p];
        }
      });
    }

    /// Products of the transposed dF/du and of dF/dv, which is symmetric, with @p x.
    [[gnu::flatten]] static void
    transposed(const LaneMesh<Pack> &mesh, const LaneSlopes<Pack> &at, const Pack *x, Pack *K_x, Pack *M_x)
    {
      for (int c = 0; c < mesh.n_cells; ++c)
      {
        set_to_zero(c, K_x);
        set_to_zero(c, M_x);
        Pack here[n], slope[n], N[n], f[n];
        evaluate<n>(mesh.tables.values, x + c * q, 1., 0., here);
        evaluate<n>(mesh.tables.derivatives, x + c * q, 1. / mesh.sizes[c], 0., slope);
        for (int p = 0; p < n; ++p)
        {
          const int i = c * n + p;
          N[p]        = at.f_w[i] * here[p] + at.N_w[i] * slope[p];
          f[p]        = at.f_u != nullptr ? at.f_u[i] * here[p] : Pack{};
        }
        add_forces<n, Pack>(mesh.tables, mesh.sizes[c], N, at.f_u != nullptr ? f : nullptr, K_x + c * q);
        for (int p = 0; p < n; ++p)
        {
          const int i = c * n + p;
          f[p]        = at.f_v[i] * here[p];
          N[p]        = at.N_rate != nullptr ? at.N_rate[i] * slope[p] : Pack{};
        }
        add_forces<n, Pack>(mesh.tables, mesh.sizes[c], N, f, M_x + c * q);
      }
    }

    static void
    transpose(Pack *K)
    {
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < i; ++j)
        {
          const Pack lower = K[i * n + j];
          K[i * n + j]     = K[j * n + i];
          K[j * n + i]     = lower;
        }
    }

    /// The factors of K + real M, and of K + (re + i im) M for each pair; with the transposed K if so wished.
    template <bool is_transposed>
    [[gnu::flatten]] static void
    factorize(const LaneMesh<Pack> &mesh,
              const Pack *u,
              const Pack *v,
              const Pack &real,
              const int n_pairs,
              const Complex<Pack> *shifts,
              Pack *blocks,
              Pack *schur,
              Complex<Pack> *complex_blocks,
              Complex<Pack> *complex_schur)
    {
      const auto any_pivot = [](const auto &) {}; // non-finite factors show in the solution
      for_cells(mesh, nullptr, [&](const auto &laws, const int c) {
        Pack K[n * n], M[n * n];
        cell_blocks<n, true>(mesh.tables, mesh.sizes[c], laws, u + c * q, v + c * q, K, M);
        if constexpr (is_transposed)
          transpose(K);
        Pack *A = blocks + c * n * n;
        for (int i = 0; i < n * n; ++i)
          A[i] = K[i] + real * M[i];
        condense_cell<q>(A, schur + 4 * c, any_pivot);
        for (int j = 0; j < n_pairs; ++j)
        {
          Complex<Pack> *B = complex_blocks + (j * mesh.n_cells + c) * n * n;
          for (int i = 0; i < n * n; ++i)
            B[i] = {K[i] + shifts[j].re * M[i], shifts[j].im * M[i]};
          condense_cell<q>(B, complex_schur + 4 * (j * mesh.n_cells + c), any_pivot);
        }
      });
    }

    static int
    n_blocks(const int n_cells)
    {
      return n_cells;
    }

    template <typename Number>
    static void
    forward(const int n_cells, const Number *blocks, Number *x)
    {
      for (int c = 0; c < n_cells; ++c)
        forward_cell<q>(blocks + c * n * n, x + c * q);
    }

    template <typename Number>
    static void
    backward(const int n_cells, const Number *blocks, Number *x)
    {
      for (int c = 0; c < n_cells; ++c)
        backward_cell<q>(blocks + c * n * n, x + c * q);
    }

    [[gnu::flatten]] static void
    integrals(const LaneMesh<Pack> &mesh, const Pack *u, const Pack *v, const Pack *m, LaneIntegrals<Pack> &sum)
    {
      for_cells(mesh, m, [&](const auto &laws, const int c) {
        cell_integrals<n>(mesh.tables, mesh.sizes[c], laws, u + c * q, v + c * q, sum);
      });
    }

    /// Integral of u over the body.
    static Pack
    integral(const LaneMesh<Pack> &mesh, const Pack *u)
    {
      Pack sum = Pack{};
      for (int c = 0; c < mesh.n_cells; ++c)
      {
        Pack at[n];
        evaluate<n>(mesh.tables.values, u + c * q, 1., 0., at);
        for (int p = 0; p < n; ++p)
          sum += mesh.sizes[c] * mesh.tables.weights[p] * at[p];
      }
      return sum;
    }

    /// Derivatives by s at both ends, from a table of derivatives at @p n_samples places that begin and end there.
    static void
    end_derivatives(
      const LaneMesh<Pack> &mesh, const int n_samples, const double *sample_derivatives, const Pack *u, Pack *ends)
    {
      const int last = mesh.n_cells - 1;
      ends[0] = ends[1] = Pack{};
      for (int j = 0; j < n; ++j)
      {
        ends[0] += sample_derivatives[j] / mesh.sizes[0] * u[j];
        ends[1] += sample_derivatives[(n_samples - 1) * n + j] / mesh.sizes[last] * u[last * q + j];
      }
    }

    /// Compares the stretch at the sample @p place of a cell with the extremes so far.
    template <typename Size>
    [[gnu::always_inline]] static inline void
    look_at_sample(
      const double *derivatives, const Size &inverse_size, const Pack *u, const Pack &place, LaneLook<Pack> &look)
    {
      Pack w{};
      for (int j = 0; j < n; ++j)
        w += derivatives[j] * u[j];
      w           = 1. + inverse_size * w;
      look.min_at = w < look.least ? place : look.min_at;
      look.least  = smaller(w, look.least);
      look.max_at = w > look.most ? place : look.max_at;
      look.most   = w > look.most ? w : look.most;
    }

    /// Smallest and largest stretch among the samples of all cells.
    static void
    extremes(const LaneMesh<Pack> &mesh,
             const int n_samples,
             const double *sample_derivatives,
             const Pack *u,
             LaneLook<Pack> &look)
    {
      for (int c = 0; c < mesh.n_cells; ++c)
        for (int i = 0; i < n_samples; ++i)
          look_at_sample(
            sample_derivatives + i * n, 1. / mesh.sizes[c], u + c * q, broadcast<Pack>(c * n_samples + i), look);
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
