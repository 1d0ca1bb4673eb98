// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_kernel_table.h>
#include <crawler/lanes/lane_laws.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_tridiagonal.h>

#include <cstddef>

/// Equations and linear systems of the position form for a pack of bodies (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Unknowns are the displacements of the nodes. The systems are K + (g/h) M and K + (l_j/h) M, g and l_j the
  /// eigenvalues of A^-1: blocks of the cells (block_tridiagonal_loops.h) and the tridiagonal system of the corners
  /// between them.
  template <typename Pack, int pairs>
  class PositionSystem
  {
  public:
    using Number                      = Complex<Pack>;
    static constexpr bool largest     = false; ///< the size of a vector is its mean square
    static constexpr bool gives_rates = true;  ///< for LaneHost::look_inside
    static constexpr bool keeps_tries = true;  ///< a failed try is a guess, see Lane::control_step

    explicit PositionSystem(const LaneSetup &setup)
      : n_unknowns(static_cast<int>(setup.n_cells * setup.degree + 1))
      , n_points(static_cast<int>(setup.n_cells * (setup.degree + 1)))
      , setup_(setup)
      , is_general_((setup.laws & LaneLaws::general) != 0)
      , general_(setup)
      , kernels_(lane_kernels<Pack>(setup.degree, setup.n_cells))
      , corners_(static_cast<int>(setup.n_cells) + 1, static_cast<int>(setup.degree))
    {
      mesh_.n_cells = static_cast<int>(setup.n_cells);
      mesh_.sizes   = setup.sizes;
      mesh_.tables  = setup.element;
      if (is_general_)
        mesh_.laws = &general_.laws;
    }
    PositionSystem(const PositionSystem &) = delete;

    const int n_unknowns, n_points;
    const int n_controlled = n_unknowns; ///< unknowns whose error is controlled

    void
    set_body(const int l, const LaneBody &body)
    {
      set_lane(mesh_.k, l, body.k);
      mesh_.friction.set(l, body.a);
      general_.set_body(l, body);
    }

    Pack
    residual(const double *t, const Pack *u, const Pack *v, const Pack *m, Pack *F)
    {
      if (!is_general_)
        return kernels_.residual(mesh_, u, v, m, F);
      const Pack least = evaluate(t, u, v, m, /*slopes=*/false);
      kernels_.residual(mesh_, u, v, m, F);
      return least;
    }

    /// Finds the extreme stretches, and if @p rates the integrals for the velocity @p v.
    void
    look(const double *t, const Pack *u, const Pack *v, const Pack *m, const bool rates, LaneLook<Pack> &result)
    {
      result.stretch = kernels_.extremes(mesh_, static_cast<int>(setup_.n_samples), setup_.sample_derivatives, u);
      if (!rates)
        return;
      if (is_general_)
        evaluate(t, u, v, m, /*slopes=*/false);
      kernels_.integrals(mesh_, u, v, m, result.sums);
      if ((setup_.laws & LaneLaws::feedback) == 0)
        return;
      for (int end = 0; end < 2; ++end)
      {
        result.end_stretch[end] = 1. + end_derivative(end, u);
        result.end_rate[end]    = end_derivative(end, v);
      }
    }

    void
    lay_out(LaneMemory &memory)
    {
      general_.lay_out(memory);
      memory.pieces(block_size(), blocks_);
      memory.pieces(pairs * block_size(), complex_blocks_);
      memory.pieces(4 * std::size_t(setup_.n_cells), schur_);
      memory.pieces(pairs * 4 * std::size_t(setup_.n_cells), complex_schur_);
      corners_.lay_out(memory);
    }

    /// Lays out the memory for slopes().
    void
    lay_out(LaneSlopes<Pack> &slopes, LaneMemory &memory) const
    {
      const std::size_t points = n_points;
      memory.pieces(points, slopes.f_v, slopes.f_w, slopes.N_w);
      if ((setup_.laws & LaneLaws::host_ground) != 0)
        memory.pieces(points, slopes.f_u);
      if ((setup_.laws & LaneLaws::rate) != 0)
        memory.pieces(points, slopes.N_rate);
    }

    /// Slopes of the laws, for the state (@p u, @p v).
    void
    slopes(const double *t, const Pack *u, const Pack *v, LaneSlopes<Pack> &at)
    {
      if (is_general_)
        evaluate(t, u, v, nullptr, /*slopes=*/true);
      kernels_.slopes(mesh_, u, v, at);
    }

    /// Products (dF/du)^T x and dF/dv x.
    void
    transposed(const LaneSlopes<Pack> &at, const Pack *x, Pack *K_x, Pack *M_x) const
    {
      kernels_.transposed(mesh_, at, x, K_x, M_x);
    }

    /// Factorizes for the state (@p u, @p v); the transposed systems on request.
    template <bool is_transposed = false>
    void
    factorize(const double *t, const Pack *u, const Pack *v, const Pack *m, const Pack &inverse_h)
    {
      if (is_general_)
        evaluate(t, u, v, m, /*slopes=*/true);
      LaneShifts<Pack, pairs> shifts;
      shifts.set(setup_, inverse_h);
      const auto factorize = is_transposed ? kernels_.factorize_transposed : kernels_.factorize;
      factorize(mesh_, u, v, shifts.real, pairs, shifts.complex, blocks_, schur_, complex_blocks_, complex_schur_);
      factorize_corners(pairs);
    }

    /// Solves with the real system and, unless @p y is null, K + (l_j/h) M for all pairs, @p y [pair][unknown].
    void
    solve(Pack *x, Number *y = nullptr) const
    {
      const int N = mesh_.n_cells, n = n_unknowns, n_pairs = y != nullptr ? pairs : 0;
      kernels_.forward(N, blocks_, x);
      for (int j = 0; j < n_pairs; ++j)
        kernels_.complex_forward(N, complex_blocks_ + j * block_size(), y + j * n);
      corners_.solve(x, y, n);
      kernels_.backward(N, blocks_, x);
      for (int j = 0; j < n_pairs; ++j)
        kernels_.complex_backward(N, complex_blocks_ + j * block_size(), y + j * n);
    }

    /// Computes the velocity @p v in which all forces balance; for general bodies by Newton's method from the given @p
    /// v. Overwrites the real factors and @p correction. Returns the error that has not settled.
    Pack
    velocity(const double *t, const Pack *u, const Pack *m, Pack *v, Pack *correction)
    {
      constexpr int max_corrections = 30;
      constexpr double settled = 1e-10, tiny = 1e-13;
      if (!is_general_)
      {
        kernels_.balance(mesh_, u, nullptr, m, v, blocks_, schur_);
        factorize_corners(0);
        solve(v);
        return Pack{};
      }
      Pack left = broadcast<Pack>(HUGE_VAL);
      for (int i = 0; i < max_corrections; ++i)
      {
        evaluate(t, u, v, m, /*slopes=*/true);
        kernels_.balance(mesh_, u, v, m, correction, blocks_, schur_);
        factorize_corners(0);
        solve(correction);
        const auto is_done = left <= 1.; // a lane does not change because others do
        Pack change{}, size{};
        for (int d = 0; d < n_unknowns; ++d)
        {
          v[d]   = is_done ? v[d] : v[d] + correction[d];
          change = added<true>(change, correction[d] < 0. ? -correction[d] : correction[d]);
          size   = added<true>(size, v[d] < 0. ? -v[d] : v[d]);
        }
        if (general_.are_linear_in_velocity())
          return Pack{};
        left     = is_done ? left : change / (settled * size + tiny);
        bool all = true;
        for (int l = 0; l < PackTraits<Pack>::size; ++l)
          all = all && get_lane(left, l) <= 1.;
        if (all)
          break;
      }
      return left;
    }

  private:
    /// Derivative by s at the left or right @p end: the samples of a cell begin and end at its own.
    Pack
    end_derivative(const int end, const Pack *u) const
    {
      const int q = static_cast<int>(setup_.degree), cell = end * (mesh_.n_cells - 1);
      const double *const by_node = setup_.sample_derivatives + end * (setup_.n_samples - 1) * (q + 1);
      Pack sum{};
      for (int j = 0; j <= q; ++j)
        sum += by_node[j] / setup_.sizes[cell] * u[cell * q + j];
      return sum;
    }

    /// Adds the Schur complements of the cells up to the matrices of the corners between them, and factorizes these.
    void
    factorize_corners(const int n_pairs) const
    {
      const auto add_up = [N = mesh_.n_cells](const auto *schur, auto *rows) {
        rows[0].pivot = schur[0];
        for (int c = 0; c < N; ++c, schur += 4)
        {
          rows[c].after      = schur[1];
          rows[c + 1].before = schur[2];
          rows[c + 1].pivot  = c + 1 < N ? schur[3] + schur[4] : schur[3];
        }
      };
      add_up(schur_, corners_.real);
      for (int j = 0; j < n_pairs; ++j)
        add_up(complex_schur_ + 4 * j * mesh_.n_cells, corners_.complex[j]);
      corners_.factorize(n_pairs);
    }

    /// Evaluates the laws for a state.
    Pack
    evaluate(const double *t, const Pack *u, const Pack *v, const Pack *m, const bool slopes)
    {
      kernels_.states(mesh_, u, v, general_.at);
      return general_.evaluate(t, mesh_.friction, m, slopes);
    }

    std::size_t
    block_size() const
    {
      return std::size_t(setup_.degree + 1) * (setup_.degree + 1) * kernels_.n_blocks(mesh_.n_cells);
    }

    const LaneSetup &setup_;
    const bool is_general_;
    GeneralLaws<Pack> general_;
    LaneMesh<Pack> mesh_;
    const LaneKernelTable<Pack> &kernels_;
    Pack *blocks_;
    Number *complex_blocks_; ///< [pair][...]
    Pack *schur_;            ///< [cell][4] Schur complements
    Number *complex_schur_;  ///< [pair][cell][4]
    LaneTridiagonal<Pack, pairs> corners_;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
