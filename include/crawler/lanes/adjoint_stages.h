// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_states.h>
#include <crawler/lanes/lane_systems.h>

#include <cstddef>

/// Stages of the adjoint in one step (included by adjoint_sweep.h, which has the equations).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Solves for the mu_i of a step by generalized conjugate residuals (Eisenstat, Elman, Schultz, SIAM J. Numer. Anal.
  /// 20 (1983) 345) with the transposed systems of simplified Newton; that iteration alone may not converge where the
  /// steps are long.
  template <int s>
  class AdjointStages
  {
  public:
    static constexpr int pairs = (s - 1) / 2, middle = s / 2, max_directions = 12;
    using System = PositionSystem<double, pairs>;

    AdjointStages(const LaneSetup &setup, System &system)
      : setup_(setup)
      , system_(system)
      , n_(system.n_unknowns)
    {
      constexpr int columns = 1 + pairs;
      for (int i = 0; i < s; ++i)
        for (int j = 0; j < columns; ++j)
          for (int part = 0; part < 2; ++part)
          {
            rows_[2 * (j * s + i) + part]          = setup.method.vectors[2 * (i * columns + j) + part];
            vectors_[2 * (i * columns + j) + part] = setup.method.rows[2 * (j * s + i) + part];
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
      for (LaneSlopes<double> &slopes : slopes_)
        system_.lay_out(slopes, memory);
    }

    /// Evaluates K_i and M_i at the @p times of the stages, and factorizes the systems.
    void
    factorize(const double (&times)[s], LaneStates<double, s> &states, const double inverse_h)
    {
      inverse_h_ = inverse_h;
      for (int i = 0; i < s; ++i)
      {
        states.go_to_stage(i, inverse_h);
        system_.slopes(&times[i], states.u, states.v, slopes_[i]);
      }
      states.go_to_stage(middle, inverse_h);
      system_.template factorize<true>(&times[middle], states.u, states.v, nullptr, inverse_h);
    }

    /// Solves for mu from its guess and the right-hand side @p right, until a correction from a residual that was
    /// computed anew changes it no more. Returns false if that does not converge.
    bool
    solve(const double *right)
    {
      // Round-off on graded meshes may be larger than `settled`.
      constexpr double settled = 1e-13, nearly_settled = 1e-8;
      constexpr int max_passes = 100;
      double last_change       = HUGE_VAL;
      bool converged           = false;
      look_at_residual(right);
      for (int pass = 0; pass < max_passes && !converged; ++pass)
      {
        const bool is_new     = n_directions_ == 0;
        const Change made     = correct();
        const bool is_settled = made.change <= settled * made.size; // false for NaN
        const bool is_stuck   = made.change <= nearly_settled * made.size && made.change >= 0.5 * last_change;
        converged             = is_new && (is_settled || is_stuck);
        if (is_new)
          last_change = made.change;
        if (is_settled || n_directions_ == max_directions)
          look_at_residual(right);
      }
      multiply(mu);
      return converged;
    }

    double *mu, *K_mu; ///< [stage][unknown] solution, and K_i^T mu_i

  private:
    /// Largest element of a correction, and of mu.
    struct Change
    {
      double change, size;
    };

    /// Multiplies K_i^T x_i and M_i x_i.
    void
    multiply(const double *x)
    {
      for (int i = 0; i < s; ++i)
        system_.transposed(slopes_[i], x + i * n_, K_mu + i * n_, M_mu_ + i * n_);
    }

    /// Left-hand side of the equations.
    void
    apply(const double *x, double *result)
    {
      multiply(x);
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
        {
          double sum = setup_.method.inverse[i] * M_mu_[d];
          for (int j = 1; j < s; ++j)
            sum += setup_.method.inverse[j * s + i] * M_mu_[j * n_ + d];
          result[i * n_ + d] = K_mu[i * n_ + d] + inverse_h_ * sum;
        }
    }

    /// Computes the residual anew, and forgets the directions.
    void
    look_at_residual(const double *right)
    {
      n_directions_ = 0;
      apply(mu, residual_);
      for (int d = 0; d < s * n_; ++d)
        residual_[d] = right[d] - residual_[d];
    }

    double
    product(const double *a, const double *b) const
    {
      double sum = 0.;
      for (int d = 0; d < s * n_; ++d)
        sum += a[d] * b[d];
      return sum;
    }

    /// Adds a multiple, a += factor b.
    void
    add(const double factor, const double *b, double *a) const
    {
      for (int d = 0; d < s * n_; ++d)
        a[d] += factor * b[d];
    }

    /// Makes one correction.
    Change
    correct()
    {
      const std::size_t n = std::size_t(s) * n_;
      double *const step  = directions_ + n_directions_ * n;
      double *const image = step + max_directions * n;
      radau::to_eigenbasis(radau::Stages<s>{}, rows_, residual_, n_, real_, complex_);
      system_.solve(real_, complex_);
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
          step[i * n_ + d] = radau::from_eigenbasis(radau::Stages<s>{}, vectors_, i, d, n_, real_, complex_);
      apply(step, image);
      for (int j = 0; j < n_directions_; ++j)
      {
        const double *const other     = directions_ + j * n;
        const double *const its_image = other + max_directions * n;
        const double part             = -product(image, its_image);
        add(part, other, step);
        add(part, its_image, image);
      }
      const double square = product(image, image), along = product(residual_, image);
      const double scale = square > 0. ? 1. / ::sqrt(square) : 0., length = square > 0. ? along / square : 0.;
      Change made{};
      for (int d = 0; d < s * n_; ++d)
      {
        const double moved = length * step[d];
        mu[d] += moved;
        made.change = added<true>(made.change, moved < 0. ? -moved : moved);
        made.size   = added<true>(made.size, mu[d] < 0. ? -mu[d] : mu[d]);
      }
      add(-length, image, residual_);
      for (int d = 0; d < s * n_; ++d)
      {
        step[d]  = scale * step[d];
        image[d] = scale * image[d];
      }
      ++n_directions_;
      return made;
    }

    const LaneSetup &setup_;
    System &system_;
    const int n_; ///< unknowns
    double inverse_h_ = 1.;
    double rows_[2 * (1 + pairs) * s], vectors_[2 * (1 + pairs) * s]; ///< eigenvectors of the transposed A^-1
    LaneSlopes<double> slopes_[s];                                    ///< slopes at the stages
    double *M_mu_, *residual_, *real_;                                ///< products, and right-hand sides in both bases
    Complex<double> *complex_;
    double *directions_; ///< [direction][stage][unknown], then their images under the equations
    int n_directions_ = 0;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
