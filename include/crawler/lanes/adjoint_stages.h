// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_states.h>
#include <crawler/lanes/lane_systems.h>

#include <cstddef>

/// Stages of the adjoint in one step (included by adjoint_lanes.h, which has the equations).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Solves for the mu_i of a step by generalized conjugate residuals (Eisenstat, Elman, Schultz, SIAM J. Numer. Anal.
  /// 20 (1983) 345) with the transposed systems of simplified Newton; that iteration alone may not converge where the
  /// steps are long.
  template <typename Pack, int s>
  class AdjointStages
  {
  public:
    static constexpr int lanes = PackTraits<Pack>::size, pairs = (s - 1) / 2, middle = s / 2, max_directions = 12;
    using System = PositionSystem<Pack, pairs>;

    AdjointStages(const LaneSetup &setup, System &system)
      : setup_(setup)
      , system_(system)
      , n_(system.n_unknowns())
    {
      constexpr int columns = 1 + pairs;
      for (int i = 0; i < s; ++i)
        for (int j = 0; j < columns; ++j)
          for (int part = 0; part < 2; ++part)
          {
            rows_[2 * (j * s + i) + part]          = setup.vectors[2 * (i * columns + j) + part];
            vectors_[2 * (i * columns + j) + part] = setup.rows[2 * (j * s + i) + part];
          }
    }

    void
    lay_out(LaneMemory &memory)
    {
      const std::size_t n = n_;
      memory.pieces(s * n, mu, K_mu, M_mu_, residual_);
      memory.pieces(2 * max_directions * s * n, directions_);
      memory.pieces(n, real_);
      memory.pieces(pairs * n, complex_);
      for (LaneSlopes<Pack> &slopes : slopes_)
        system_.lay_out(slopes, system_.n_points(), memory);
    }

    /// Evaluates K_i and M_i at the @p times of the stages, and factorizes the systems.
    void
    factorize(const double (&times)[s][lanes], LaneStates<Pack, s> &states, const Pack &inverse_h)
    {
      inverse_h_ = inverse_h;
      for (int i = 0; i < s; ++i)
      {
        states.go_to_stage(i, inverse_h);
        system_.slopes(times[i], states.u, states.v, slopes_[i]);
      }
      states.go_to_stage(middle, inverse_h);
      system_.template factorize<true>(times[middle], states.u, states.v, nullptr, inverse_h);
    }

    /// Solves for mu from its guess and the right-hand side @p right, in the lanes of which @p is_busy(l) is true.
    template <typename IsBusy>
    void
    solve(const Pack *right, const IsBusy &is_busy)
    {
      constexpr int max_passes = 100;
      for (int l = 0; l < lanes; ++l)
        lanes_[l] = {is_busy(l), HUGE_VAL};
      n_directions_ = 0;
      look_at_residual(right);
      for (int pass = 0; pass < max_passes && any(lanes_, &Lane::iterating); ++pass)
      {
        const bool settles = correct();
        if (settles || n_directions_ == max_directions)
        {
          look_at_residual(right);
          n_directions_ = 0;
        }
      }
      multiply(mu);
    }

    bool
    has_failed(const int l) const
    {
      return lanes_[l].iterating;
    }

    Pack *mu, *K_mu; ///< [stage][unknown] solution, and K_i^T mu_i

  private:
    struct Lane
    {
      bool iterating;
      double last_change;
    };

    /// Multiplies K_i^T x_i and M_i x_i.
    void
    multiply(const Pack *x)
    {
      for (int i = 0; i < s; ++i)
        system_.transposed(slopes_[i], x + i * n_, K_mu + i * n_, M_mu_ + i * n_);
    }

    /// Left-hand side of the equations.
    void
    apply(const Pack *x, Pack *result)
    {
      multiply(x);
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
        {
          Pack sum = setup_.inverse[i] * M_mu_[d];
          for (int j = 1; j < s; ++j)
            sum += setup_.inverse[j * s + i] * M_mu_[j * n_ + d];
          result[i * n_ + d] = K_mu[i * n_ + d] + inverse_h_ * sum;
        }
    }

    void
    look_at_residual(const Pack *right)
    {
      apply(mu, residual_);
      for (int d = 0; d < s * n_; ++d)
        residual_[d] = right[d] - residual_[d];
    }

    Pack
    product(const Pack *a, const Pack *b) const
    {
      Pack sum{};
      for (int d = 0; d < s * n_; ++d)
        sum += a[d] * b[d];
      return sum;
    }

    /// Adds a multiple, a += factor b.
    void
    add(const Pack &factor, const Pack *b, Pack *a) const
    {
      for (int d = 0; d < s * n_; ++d)
        a[d] += factor * b[d];
    }

    /// Makes one correction; lanes that are done keep their values. A lane is done if it would not change any more
    /// although the residual was computed anew. Returns true if the residual should be evaluated.
    bool
    correct()
    {
      // Round-off on graded meshes may be larger than `settled`.
      constexpr double settled = 1e-13, nearly_settled = 1e-8;
      const bool is_new   = n_directions_ == 0;
      const std::size_t n = std::size_t(s) * n_;
      Pack *const step    = directions_ + n_directions_ * n;
      Pack *const image   = step + max_directions * n;
      radau::to_eigenbasis(radau::Stages<s>{}, rows_, residual_, n_, real_, complex_);
      system_.solve(real_, complex_);
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
          step[i * n_ + d] = radau::from_eigenbasis(radau::Stages<s>{}, vectors_, i, d, n_, real_, complex_);
      apply(step, image);
      for (int j = 0; j < n_directions_; ++j)
      {
        const Pack *const other     = directions_ + j * n;
        const Pack *const its_image = other + max_directions * n;
        const Pack part             = -product(image, its_image);
        add(part, other, step);
        add(part, its_image, image);
      }
      const Pack square = product(image, image), along = product(residual_, image);
      Pack scale{}, length{};
      for (int l = 0; l < lanes; ++l)
      {
        const double of_lane = get_lane(square, l);
        set_lane(scale, l, of_lane > 0. ? 1. / ::sqrt(of_lane) : 0.);
        set_lane(length, l, lanes_[l].iterating && of_lane > 0. ? get_lane(along, l) / of_lane : 0.);
      }
      Pack change{}, size{};
      for (int d = 0; d < s * n_; ++d)
      {
        const Pack moved = length * step[d];
        mu[d] += moved;
        change = added<true>(change, moved < 0. ? -moved : moved);
        size   = added<true>(size, mu[d] < 0. ? -mu[d] : mu[d]);
      }
      add(-length, image, residual_);
      for (int d = 0; d < s * n_; ++d)
      {
        step[d]  = scale * step[d];
        image[d] = scale * image[d];
      }
      ++n_directions_;
      bool looks = false;
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (!lane.iterating)
          continue;
        const double its_change = get_lane(change, l), its_size = get_lane(size, l);
        const bool is_settled = its_change <= settled * its_size; // false for NaN
        if (is_new && (is_settled || (its_change <= nearly_settled * its_size && its_change >= 0.5 * lane.last_change)))
          lane.iterating = false;
        else if (is_settled)
          looks = true;
        if (is_new)
          lane.last_change = its_change;
      }
      return looks;
    }

    const LaneSetup &setup_;
    System &system_;
    const int n_; ///< unknowns
    Lane lanes_[lanes];
    Pack inverse_h_;
    double rows_[2 * (1 + pairs) * s], vectors_[2 * (1 + pairs) * s]; ///< eigenvectors of the transposed A^-1
    LaneSlopes<Pack> slopes_[s];                                      ///< slopes at the stages
    Pack *M_mu_, *residual_, *real_;                                  ///< products, and right-hand sides in both bases
    Complex<Pack> *complex_;
    Pack *directions_; ///< [direction][stage][unknown], then their images under the equations
    int n_directions_ = 0;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
