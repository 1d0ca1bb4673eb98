// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/discretization/stretch_loops.h>
#include <crawler/fused/lane_engine.h>
#include <crawler/fused/lane_kernels.h>
#include <crawler/fused/lane_memory.h>

#include <cstddef>

/// The equations and linear systems of the stretch form for a pack of bodies (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// The smallest w^(1+a) that is looked at, where that is what the unknown is made of.
  constexpr double least_power = 1e-8;

  /**
   * The unknowns are those of the cells, and last the displacement of the left end, u_0' = v_0. That of a cell is its
   * stretch w; or q = w^(1+a)/(1+a), -1 < a < 0, which passes 0 at a finite rate where a body inverts (LaneSetup).
   *
   *   F_j = q_j' - c_j (v_{j+1} - v_j)/h_j,   c = dq/dw,        F_n = u_0' - v_0
   */
  template <typename Pack, int pairs>
  class StretchSystem
  {
  public:
    using Number                  = Complex<Pack>;
    static constexpr int lanes    = PackTraits<Pack>::size;
    static constexpr bool largest = true; ///< is the size of a vector that of its largest element, else the mean square

    StretchSystem(const LaneSetup &setup, const LaneHost &host)
      : setup_(setup)
      , host_(host)
      , n_(static_cast<int>(setup.n_cells))
      , rule_(static_cast<NodeRule>(setup.node_rule))
    {
    }

    int
    n_unknowns() const
    {
      return n_ + 1;
    }
    /// Of these the error is controlled.
    int
    n_controlled() const
    {
      return n_;
    }
    int
    n_points() const
    {
      return n_;
    }

    void
    lay_out(LaneMemory &memory)
    {
      const std::size_t n = n_;
      memory.piece(w_, n);
      memory.piece(slope_, n);
      memory.piece(mobility_, n);
      memory.piece(mobility_slope_, n);
      memory.piece(force_, n);
      memory.piece(force_by_w_, n);
      memory.piece(force_by_rate_, n);
      memory.piece(rate_, n);
      memory.piece(rows_, n);
      memory.piece(real_, n);
      for (int p = 0; p < pairs; ++p)
        memory.piece(complex_[p], n);
    }

    void
    set_body(const int l, const LaneJob &job)
    {
      set_lane(k_, l, job.k);
      set_lane(a_, l, job.a);
      set_lane(friction_.a, l, -job.a);
    }

    void
    sort_bodies()
    {
      friction_.sort();
    }

    /// Of the state @p q with the rates @p q_dot and the active stress @p m, at a time for each lane. Returns a number
    /// that is not positive where the equation has no meaning.
    Pack
    residual(const double *t, const Pack *q, const Pack *q_dot, const Pack *m, Pack *F)
    {
      const Pack least = evaluate(t, q, q_dot, m, /*slopes=*/false);
      Pack left        = velocity_of_node(0);
      F[n_]            = q_dot[n_] - left;
      for (int j = 0; j < n_; ++j)
      {
        const Pack right = velocity_of_node(j + 1), change = (right - left) * (1. / setup_.sizes[j]);
        F[j] = setup_.is_power ? q_dot[j] - change / slope_[j] : q_dot[j] - change;
        left = right;
      }
      return least;
    }

    /// For the state (@p q, @p q_dot): the matrices with the eigenvalues of the method.
    void
    factorize(const double *t, const Pack *q, const Pack *q_dot, const Pack *m, const Pack &inverse_h)
    {
      evaluate(t, q, q_dot, m, /*slopes=*/true);
      Number shifts[pairs];
      for (int p = 0; p < pairs; ++p)
        shifts[p] = {setup_.eigenvalues[2 * p] * inverse_h, setup_.eigenvalues[2 * p + 1] * inverse_h};
      shift_                 = setup_.real_eigenvalue * inverse_h;
      const bool sees_rate   = setup_.sees_rate;
      const double *h        = setup_.sizes;
      const auto derivatives = [&](const int i, Node &node)
      {
        const NodeForce<Pack> f = node_force(rule_, n_, h, mobility_, force_, i);
        Pack turn               = broadcast<Pack>(1.);
        node.v                  = direct(f.slope * f.mobility.value, turn);
        const Pack conductance = turn * f.mobility.value * (1. / f.spacing), force = turn * f.slope;
        node.by_left = node.by_right = node.by_left_rate = node.by_right_rate = Pack{};
        if (i > 0)
        {
          node.by_left =
            (force * f.mobility.by_left * mobility_slope_[i - 1] - conductance * force_by_w_[i - 1]) * slope_[i - 1];
          if (sees_rate)
            node.by_left_rate = -conductance * force_by_rate_[i - 1];
        }
        if (i < n_)
        {
          node.by_right = (force * f.mobility.by_right * mobility_slope_[i] + conductance * force_by_w_[i]) * slope_[i];
          if (sees_rate)
            node.by_right_rate = conductance * force_by_rate_[i];
        }
      };
      Node left, right;
      derivatives(0, left);
      end_by_w_    = -left.by_right;
      end_by_rate_ = -left.by_right_rate;
      for (int j = 0; j < n_; ++j)
      {
        derivatives(j + 1, right);
        const Pack c = -1. / (h[j] * slope_[j]);
        Row &row     = rows_[j];
        row.K[0]     = -c * left.by_left;
        row.K[1]     = c * (right.by_left - left.by_right);
        row.K[2]     = c * right.by_right;
        if (setup_.is_power) // dc/dq = a/w
          row.K[1] += a_ * (right.v - left.v) * (-1. / h[j]) / w_[j];
        if (sees_rate)
        {
          row.M[0] = -c * left.by_left_rate;
          row.M[1] = 1. + c * (right.by_left_rate - left.by_right_rate);
          row.M[2] = c * right.by_right_rate;
        }
        left = right;
      }
      // From both ends to the middle, all systems at once: the processor does these chains of operations side by side.
      const int middle = n_ / 2;
      for (int j = 0; j < n_; ++j)
      {
        shifted(j, shift_, real_[j]);
        for (int p = 0; p < pairs; ++p)
          shifted(j, shifts[p], complex_[p][j]);
      }
      for (int i = 0; i < middle || n_ - 1 - i > middle; ++i)
      {
        const int up = n_ - 1 - i;
        if (i < middle)
        {
          eliminate_down(real_[i], real_[i + 1]);
          for (int p = 0; p < pairs; ++p)
            eliminate_down(complex_[p][i], complex_[p][i + 1]);
        }
        if (up > middle)
        {
          eliminate_up(real_[up], real_[up - 1]);
          for (int p = 0; p < pairs; ++p)
            eliminate_up(complex_[p][up], complex_[p][up - 1]);
        }
      }
      real_[middle].pivot = 1. / real_[middle].pivot;
      for (int p = 0; p < pairs; ++p)
      {
        complex_[p][middle].pivot = 1. / complex_[p][middle].pivot;
        shifts_[p]                = shifts[p];
      }
    }

    void
    solve(Pack *x) const
    {
      solve_all(x, static_cast<Number *>(nullptr));
    }

    /// The real system and those of all pairs, @p y [pair][unknown].
    void
    solve_all(Pack *x, Number *y) const
    {
      const int middle = n_ / 2;
      for (int i = 0; i < middle || n_ - 1 - i > middle; ++i)
      {
        const int up = n_ - 1 - i;
        if (i < middle)
        {
          x[i + 1] -= real_[i + 1].before * x[i];
          for (int p = 0; p < pairs && y != nullptr; ++p)
            y[p * (n_ + 1) + i + 1] -= complex_[p][i + 1].before * y[p * (n_ + 1) + i];
        }
        if (up > middle)
        {
          x[up - 1] -= real_[up - 1].after * x[up];
          for (int p = 0; p < pairs && y != nullptr; ++p)
            y[p * (n_ + 1) + up - 1] -= complex_[p][up - 1].after * y[p * (n_ + 1) + up];
        }
      }
      x[middle] *= real_[middle].pivot;
      for (int p = 0; p < pairs && y != nullptr; ++p)
        y[p * (n_ + 1) + middle] *= complex_[p][middle].pivot;
      for (int i = 1; middle - i >= 0 || middle + i < n_; ++i)
      {
        const int down = middle - i, up = middle + i;
        if (down >= 0)
        {
          x[down] = x[down] * real_[down].pivot - real_[down].after * x[down + 1];
          for (int p = 0; p < pairs && y != nullptr; ++p)
            substitute(complex_[p][down].pivot, complex_[p][down].after, y + p * (n_ + 1) + down, 1);
        }
        if (up < n_)
        {
          x[up] = x[up] * real_[up].pivot - real_[up].before * x[up - 1];
          for (int p = 0; p < pairs && y != nullptr; ++p)
            substitute(complex_[p][up].pivot, complex_[p][up].before, y + p * (n_ + 1) + up, -1);
        }
      }
      x[n_] = (x[n_] - (end_by_w_ + shift_ * end_by_rate_) * x[0]) / shift_;
      for (int p = 0; p < pairs && y != nullptr; ++p)
      {
        Number &rest   = y[p * (n_ + 1) + n_];
        const Number c = {end_by_w_ + shifts_[p].re * end_by_rate_, shifts_[p].im * end_by_rate_};
        rest -= c * y[p * (n_ + 1)];
        rest *= 1. / shifts_[p];
      }
    }

    /// The smallest and the largest stretch; the rates are the host's business.
    void
    look(const Pack *q, const Pack *, const Pack *, const bool, LaneLook<Pack> &result)
    {
      find_stretch(q);
      for (int j = 0; j < n_; ++j)
      {
        const Pack place = broadcast<Pack>(j);
        result.least_at  = w_[j] < result.least ? place : result.least_at;
        result.least     = smaller(w_[j], result.least);
        result.most_at   = w_[j] > result.most ? place : result.most_at;
        result.most      = w_[j] > result.most ? w_[j] : result.most;
      }
    }

    /// The displacement of all the body is the host's business, too.
    Pack
    integral(const Pack *) const
    {
      return Pack{};
    }

    void
    velocity(const Pack *, const Pack *, Pack *)
    {
    }

  private:
    struct Node
    {
      Pack v, by_left, by_right, by_left_rate, by_right_rate;
    };

    /// v for the velocity that the ground would give without its direction, and the derivative.
    Pack
    direct(const Pack &v, Pack &slope) const
    {
      if constexpr (lanes == 1)
        if (setup_.backward_ratio != 1.)
          return NodeDirection{setup_.backward_ratio, setup_.switching_velocity}.velocity(v, slope);
      return v;
    }

    Pack
    velocity_of_node(const int i) const
    {
      const NodeForce<Pack> f = node_force(rule_, n_, setup_.sizes, mobility_, force_, i);
      Pack slope{};
      return direct(f.slope * f.mobility.value, slope);
    }

    /// w and dw/dq.
    void
    find_stretch(const Pack *q)
    {
      if (!setup_.is_power)
      {
        for (int j = 0; j < n_; ++j)
        {
          w_[j]     = q[j];
          slope_[j] = broadcast<Pack>(1.);
        }
        return;
      }
      const Pack b = 1. + a_, inverse = 1. / b, least = least_power * inverse;
      for (int j = 0; j < n_; ++j)
        rate_[j] = b * (q[j] > least ? q[j] : least);
      power_at_points(rate_, inverse, w_, n_);
      for (int j = 0; j < n_; ++j)
        slope_[j] = w_[j] / rate_[j];
    }

    Pack
    evaluate(const double *t, const Pack *q, const Pack *q_dot, const Pack *m, const bool slopes)
    {
      constexpr double nothing = 1e-300;
      find_stretch(q);
      Pack least = broadcast<Pack>(1.);
      if constexpr (lanes == 1)
        if (host_.laws != nullptr)
        {
          for (int j = 0; j < n_; ++j)
            rate_[j] = q_dot[j] * slope_[j];
          return host_.laws(
            host_.context, *t, m, w_, rate_, mobility_, mobility_slope_, force_, force_by_w_, force_by_rate_);
        }
      for (int j = 0; j < n_; ++j)
      {
        force_[j] = m[j] + k_ * (w_[j] - 1.);
        rate_[j]  = w_[j] > nothing ? w_[j] : broadcast<Pack>(nothing);
        least     = a_ < 0. ? least : smaller(w_[j], least);
      }
      friction_(rate_, mobility_, n_);
      for (int j = 0; j < n_; ++j)
        mobility_[j] = w_[j] > nothing ? mobility_[j] : Pack{};
      if (slopes)
        for (int j = 0; j < n_; ++j)
        {
          mobility_slope_[j] = -a_ * mobility_[j] / rate_[j];
          force_by_w_[j]     = k_;
        }
      return least;
    }

    /// K and M below, on and above the diagonal.
    struct Row
    {
      Pack K[3], M[3];
    };

    /**
     * A row of K + shift M and then of its factors: what is taken of the row before and of the row after while the rows
     * are eliminated from both ends, and 1/pivot; on the way back the same two, times the pivot.
     */
    template <typename Type>
    struct Factors
    {
      Type before, pivot, after;
    };

    void
    shifted(const int j, const Pack &shift, Factors<Pack> &result) const
    {
      const Row &row = rows_[j];
      if (setup_.sees_rate)
        result = {row.K[0] + shift * row.M[0], row.K[1] + shift * row.M[1], row.K[2] + shift * row.M[2]};
      else
        result = {row.K[0], row.K[1] + shift, row.K[2]};
    }

    void
    shifted(const int j, const Number &shift, Factors<Number> &result) const
    {
      const Row &row = rows_[j];
      if (setup_.sees_rate)
        result = {{row.K[0] + shift.re * row.M[0], shift.im * row.M[0]},
                  {row.K[1] + shift.re * row.M[1], shift.im * row.M[1]},
                  {row.K[2] + shift.re * row.M[2], shift.im * row.M[2]}};
      else
        result = {{row.K[0], Pack{}}, {row.K[1] + shift.re, shift.im}, {row.K[2], Pack{}}};
    }

    template <typename Type>
    static void
    eliminate_down(Factors<Type> &row, Factors<Type> &next)
    {
      row.pivot = 1. / row.pivot;
      row.after = row.after * row.pivot;
      next.pivot -= next.before * row.after;
      next.before = next.before * row.pivot;
    }

    template <typename Type>
    static void
    eliminate_up(Factors<Type> &row, Factors<Type> &next)
    {
      row.pivot  = 1. / row.pivot;
      row.before = row.before * row.pivot;
      next.pivot -= next.after * row.before;
      next.after = next.after * row.pivot;
    }

    /// y = pivot y - factor (the next one).
    static void
    substitute(const Number &pivot, const Number &factor, Number *y, const int next)
    {
      Number result = pivot * y[0];
      result -= factor * y[next];
      y[0] = result;
    }

    const LaneSetup &setup_;
    const LaneHost &host_;
    const int n_;
    const NodeRule rule_;
    LaneFriction<Pack> friction_; ///< of the mobility, w^-a
    Pack k_, a_, shift_, end_by_w_, end_by_rate_;
    Number shifts_[pairs];
    Pack *w_, *slope_, *mobility_, *mobility_slope_, *force_, *force_by_w_, *force_by_rate_; ///< [cell]
    Pack *rate_;                                                                             ///< [cell] scratch
    Row *rows_;
    Factors<Pack> *real_;
    Factors<Number> *complex_[pairs];
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
