// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_kernels.h>
#include <crawler/lanes/lane_memory.h>

#include <cstddef>

/// The equations and linear systems of the position form for a pack of bodies (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// The unknowns are the displacements of the nodes. The systems are K + (g/h) M and K + (l_j/h) M, g and l_j the
  /// eigenvalues of A^-1: blocks of the cells (block_tridiagonal_loops.h) and the tridiagonal system of the corners
  /// between them.
  template <typename Pack, int pairs>
  class PositionSystem
  {
  public:
    using Number                      = Complex<Pack>;
    static constexpr bool largest     = false; ///< the size of a vector is its mean square
    static constexpr bool gives_rates = true;  ///< for LaneHost::look_inside

    PositionSystem(const LaneSetup &setup, const LaneHost &)
      : setup_(setup)
      , kernels_(lane_kernels<Pack>(setup.degree))
    {
      mesh_.n_cells = static_cast<int>(setup.n_cells);
      mesh_.sizes   = setup.sizes;
      mesh_.tables  = {setup.values, setup.derivatives, setup.weights, setup.stiffness};
    }

    int
    n_unknowns() const
    {
      return static_cast<int>(setup_.n_cells * setup_.degree + 1);
    }
    int
    n_controlled() const
    {
      return n_unknowns();
    }
    int
    n_points() const
    {
      return static_cast<int>(setup_.n_cells * (setup_.degree + 1));
    }

    void
    set_body(const int l, const LaneJob &job)
    {
      set_lane(mesh_.k, l, job.k);
      set_lane(mesh_.friction.a, l, job.a);
    }

    void
    sort_bodies()
    {
      mesh_.friction.sort();
    }

    Pack
    residual(const double *, const Pack *u, const Pack *v, const Pack *m, Pack *F) const
    {
      return kernels_.residual(mesh_, u, v, m, F);
    }

    /// The extreme stretches, and if @p rates the integrals for the velocity @p v.
    void
    look(const Pack *u, const Pack *v, const Pack *m, const bool rates, LaneLook<Pack> &result) const
    {
      kernels_.extremes(mesh_,
                        static_cast<int>(setup_.n_samples),
                        setup_.sample_derivatives,
                        u,
                        &result.least,
                        &result.least_at,
                        &result.most,
                        &result.most_at);
      if (rates)
        kernels_.integrals(mesh_, u, v, m, result.sums);
    }

    Pack
    integral(const Pack *u) const
    {
      return kernels_.integral(mesh_, u);
    }

    void
    lay_out(LaneMemory &memory)
    {
      const std::size_t cells = setup_.n_cells, block = block_size(), corners = cells + 1;
      memory.piece(blocks_, block);
      memory.piece(schur_, 4 * cells);
      memory.piece(lower_, corners);
      memory.piece(pivot_, corners);
      memory.piece(upper_, corners);
      memory.piece(complex_blocks_, pairs * block);
      memory.piece(complex_schur_, pairs * 4 * cells);
      memory.piece(complex_lower_, pairs * corners);
      memory.piece(complex_pivot_, pairs * corners);
      memory.piece(complex_upper_, pairs * corners);
    }

    /// For the state (@p u, @p v).
    void
    factorize(const double *, const Pack *u, const Pack *v, const Pack *, const Pack &inverse_h)
    {
      Number shifts[pairs];
      for (int j = 0; j < pairs; ++j)
        shifts[j] = {setup_.eigenvalues[2 * j] * inverse_h, setup_.eigenvalues[2 * j + 1] * inverse_h};
      kernels_.factorize(mesh_,
                         u,
                         v,
                         setup_.real_eigenvalue * inverse_h,
                         pairs,
                         shifts,
                         blocks_,
                         schur_,
                         complex_blocks_,
                         complex_schur_);
      const int N = mesh_.n_cells;
      factorize_corners(schur_, lower_, pivot_, upper_);
      for (int j = 0; j < pairs; ++j)
        factorize_corners(complex_schur_ + 4 * j * N,
                          complex_lower_ + j * (N + 1),
                          complex_pivot_ + j * (N + 1),
                          complex_upper_ + j * (N + 1));
    }

    /// With K + (g/h) M.
    void
    solve(Pack *x) const
    {
      kernels_.forward(mesh_.n_cells, blocks_, x);
      solve_corners(lower_, pivot_, upper_, x);
      kernels_.backward(mesh_.n_cells, blocks_, x);
    }

    /// With K + (l_j/h) M.
    void
    solve_complex(const int j, Number *x) const
    {
      const int N         = mesh_.n_cells;
      const Number *block = complex_blocks_ + j * block_size();
      kernels_.complex_forward(N, block, x);
      solve_corners(complex_lower_ + j * (N + 1), complex_pivot_ + j * (N + 1), complex_upper_ + j * (N + 1), x);
      kernels_.complex_backward(N, block, x);
    }

    /// The real system and those of all pairs, @p y [pair][unknown].
    void
    solve_all(Pack *x, Number *y) const
    {
      solve(x);
      for (int p = 0; p < pairs; ++p)
        solve_complex(p, y + p * n_unknowns());
    }

    /// The velocity @p v in which all forces balance. Takes the place of the real factors.
    void
    velocity(const Pack *u, const Pack *m, Pack *v)
    {
      kernels_.balance(mesh_, u, m, v, blocks_, schur_);
      factorize_corners(schur_, lower_, pivot_, upper_);
      solve(v);
    }

  private:
    std::size_t
    block_size() const
    {
      return std::size_t(setup_.degree + 1) * (setup_.degree + 1) * setup_.n_cells;
    }

    /// Factors below the diagonal, 1/pivots, upper diagonal.
    template <typename Type>
    void
    factorize_corners(const Type *schur, Type *lower, Type *pivot, Type *upper) const
    {
      const int N   = mesh_.n_cells;
      Type diagonal = schur[0];
      for (int c = 0; c < N; ++c)
      {
        const Type *S = schur + 4 * c;
        pivot[c]      = 1. / diagonal;
        upper[c]      = S[1];
        lower[c]      = S[2] * pivot[c];
        diagonal      = S[3];
        diagonal -= lower[c] * upper[c];
        if (c + 1 < N)
          diagonal += S[4];
      }
      pivot[N] = 1. / diagonal;
    }

    template <typename Type>
    void
    solve_corners(const Type *lower, const Type *pivot, const Type *upper, Type *x) const
    {
      const int N = mesh_.n_cells, q = static_cast<int>(setup_.degree);
      for (int c = 0; c < N; ++c)
        x[(c + 1) * q] -= lower[c] * x[c * q];
      x[N * q] *= pivot[N];
      for (int c = N - 1; c >= 0; --c)
      {
        x[c * q] -= upper[c] * x[(c + 1) * q];
        x[c * q] *= pivot[c];
      }
    }

    const LaneSetup &setup_;
    LaneMesh<Pack> mesh_;
    const LaneKernelTable<Pack> &kernels_;
    Pack *blocks_, *schur_, *lower_, *pivot_, *upper_;
    Number *complex_blocks_, *complex_schur_, *complex_lower_, *complex_pivot_, *complex_upper_; ///< [pair][...]
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
