// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/equation/stretch_loops.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_friction.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_mesh.h>
#include <crawler/lanes/lane_tridiagonal.h>

/// Equations and linear systems of the stretch form for one body (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Floor of w^(1+a) where the unknown is made of it.
  constexpr double min_power = 1e-8;

  /**
   * Unknowns are those of the cells, and last the displacement of the left end, u_0' = v_0. That of a cell is its
   * stretch w; or q = w^(1+a)/(1+a), -1 < a < 0, which passes 0 at a finite rate where a body inverts (LaneSetup).
   *
   *   F_j = q_j' - c_j (v_{j+1} - v_j)/h_j,   c = dq/dw,        F_n = u_0' - v_0
   */
  template <typename Pack, int pairs>
  class StretchSystem
  {
  public:
    using Number                      = Complex<Pack>;
    static constexpr bool largest     = true;  ///< the size of a vector is its largest element, else the mean square
    static constexpr bool gives_rates = false; ///< for LaneHost::look_inside
    static constexpr bool keeps_tries = false;
    static_assert(PackTraits<Pack>::size == 1, "batches are of the position form (batch_method)");

    explicit StretchSystem(const LaneSetup &setup)
      : n_points(static_cast<int>(setup.n_cells))
      , setup_(setup)
      , nodes_{setup.stretch.node_rule, n_points, setup.sizes, setup.direction}
      , cells_(n_points)
    {
    }

    const int n_points;                                           ///< cells
    const int n_unknowns = n_points + 1, n_controlled = n_points; ///< all, and those whose error is controlled

    void
    lay_out(LaneMemory &memory)
    {
      memory.pieces(n_points, power_, slope_, mobility_, mobility_slope_, force_, force_slope_);
      memory.pieces(n_points + 1, scratch_);
      cells_.lay_out(memory);
    }

    void
    set_body(const int l, const LaneBody &body)
    {
      host_ = body.host;
      set_lane(k_, l, body.k);
      set_lane(a_, l, body.a);
      friction_.set(l, -body.a);
    }

    /// Residual of the state @p q with the rates @p q_dot and the active stress @p m, at a time for each lane. Returns
    /// a number that is not positive where the equation has no meaning.
    Pack
    residual(const double *t, const Pack *q, const Pack *q_dot, const Pack *m, Pack *F)
    {
      const Pack least = evaluate(t, q, q_dot, m, /*slopes=*/false);
      Pack *const v    = scratch_;
      nodes_.velocities(v);
      F[n_points] = q_dot[n_points] - v[0];
      for (int j = 0; j < n_points; ++j)
      {
        const Pack change = (v[j + 1] - v[j]) * (1. / setup_.sizes[j]);
        F[j]              = setup_.stretch.is_power ? q_dot[j] - change / slope_[j] : q_dot[j] - change;
      }
      return least;
    }

    /// Factorizes the matrices with the eigenvalues of the method for the state (@p q, @p q_dot).
    void
    factorize(const double *t, const Pack *q, const Pack *q_dot, const Pack *m, const Pack &inverse_h)
    {
      evaluate(t, q, q_dot, m, /*slopes=*/true);
      shifts_.set(setup_, inverse_h);
      const bool sees_rate = nodes_.laws.force_by_rate != nullptr;
      const double *h      = setup_.sizes;
      auto left            = nodes_.with_derivatives(0);
      end_                 = {-left.by_right, -left.by_right_rate};
      for (int j = 0; j < n_points; ++j)
      {
        const auto right = nodes_.with_derivatives(j + 1);
        const Pack c     = setup_.stretch.is_power ? -1. / (h[j] * slope_[j]) : broadcast<Pack>(-1. / h[j]);
        Pack K[]         = {-c * left.by_left, c * (right.by_left - left.by_right), c * right.by_right};
        Pack M[]         = {Pack{}, broadcast<Pack>(1.), Pack{}};
        if (setup_.stretch.is_power) // derivative dc/dq = a/w
          K[1] += a_ * (right.v - left.v) * (-1. / h[j]) / w_[j];
        if (sees_rate)
        {
          M[0] = -c * left.by_left_rate;
          M[1] += c * (right.by_left_rate - left.by_right_rate);
          M[2] = c * right.by_right_rate;
        }
        const auto real    = [&](const int i) { return K[i] + shifts_.real * M[i]; };
        const auto complex = [&](const int i, const Number &shift) {
          return Number{K[i] + shift.re * M[i], shift.im * M[i]};
        };
        cells_.real[j] = {real(0), real(1), real(2)};
        for (int p = 0; p < pairs; ++p)
        {
          const Number &shift  = shifts_.complex[p];
          cells_.complex[p][j] = {complex(0, shift), complex(1, shift), complex(2, shift)};
        }
        left = right;
      }
      cells_.factorize(pairs);
    }

    /// Solves the real system and those of all pairs, @p y [pair][unknown]; null: the real one alone.
    void
    solve(Pack *x, Number *y = nullptr) const
    {
      cells_.solve(x, y, n_unknowns);
      x[n_points] = (x[n_points] - (end_.K + shifts_.real * end_.M) * x[0]) / shifts_.real;
      for (int p = 0; p < pairs && y != nullptr; ++p)
      {
        Number *own    = y + p * n_unknowns;
        const Number c = {end_.K + shifts_.complex[p].re * end_.M, shifts_.complex[p].im * end_.M};
        own[n_points] -= c * own[0];
        own[n_points] *= 1. / shifts_.complex[p];
      }
    }

    /// Finds the smallest and the largest stretch.
    void
    look(const double *, const Pack *q, const Pack *, const Pack *, const bool, LaneLook<Pack> &result)
    {
      find_stretch(q);
      for (int j = 0; j < n_points; ++j)
        result.stretch.see(w_[j], broadcast<Pack>(j));
    }

  private:
    /// Computes w, and dw/dq where that is not 1.
    void
    find_stretch(const Pack *q)
    {
      w_ = setup_.stretch.is_power ? power_ : q;
      if (!setup_.stretch.is_power)
        return;
      const Pack b = 1. + a_, inverse = 1. / b, least = min_power * inverse;
      for (int j = 0; j < n_points; ++j)
        scratch_[j] = b * (q[j] > least ? q[j] : least);
      power_at_points(scratch_, inverse, power_, n_points);
      for (int j = 0; j < n_points; ++j)
        slope_[j] = w_[j] / scratch_[j];
    }

    Pack
    evaluate(const double *t, const Pack *q, const Pack *q_dot, const Pack *m, const bool slopes)
    {
      constexpr double nothing = 1e-300;
      if ((setup_.laws & LaneLaws::general) != 0) // the unknowns are no powers
        return host_->evaluate_cells(*t, m, q, q_dot, nodes_.laws);
      find_stretch(q);
      Pack least = broadcast<Pack>(1.);
      for (int j = 0; j < n_points; ++j)
      {
        force_[j]   = equation::body_force<Pack>(w_[j] - 1., m[j], k_);
        scratch_[j] = w_[j] > nothing ? w_[j] : broadcast<Pack>(nothing);
        least       = a_ < 0. ? least : smaller(w_[j], least);
      }
      friction_(scratch_, mobility_, n_points);
      for (int j = 0; j < n_points; ++j)
        mobility_[j] = w_[j] > nothing ? mobility_[j] : Pack{};
      for (int j = 0; slopes && j < n_points; ++j)
      {
        const Pack slope   = setup_.stretch.is_power ? slope_[j] : broadcast<Pack>(1.);
        mobility_slope_[j] = -a_ * mobility_[j] / scratch_[j] * slope;
        force_slope_[j]    = k_ * slope;
      }
      nodes_.laws = {mobility_, mobility_slope_, force_, force_slope_, nullptr};
      return least;
    }

    const LaneSetup &setup_;
    LawHost *host_ = nullptr; ///< of a general body
    StretchNodes<Pack> nodes_;
    LaneFriction<Pack> friction_; ///< friction that gives the mobility, w^-a
    Pack k_, a_;
    LaneShifts<Pack, pairs> shifts_;
    LaneTridiagonal<Pack, pairs> cells_;
    /// Entries of the last row, that of u_0, in the column of the first cell.
    struct
    {
      Pack K, M;
    } end_;
    const Pack *w_;                                            ///< [cell]
    Pack *power_, *slope_;                                     ///< [cell] w and dw/dq if q is a power
    Pack *mobility_, *mobility_slope_, *force_, *force_slope_; ///< [cell] laws of plain bodies
    Pack *scratch_;                                            ///< [node]
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
