// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/adjoint_host.h>
#include <crawler/lanes/adjoint_stages.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_states.h>
#include <crawler/lanes/lane_systems.h>

#include <cstddef>

/**
 * Discrete adjoint of the Radau IIA methods (doc/numerics.md, "Sensitivities"; Hairer, Hochbruck,
 * Iserles, Lubich, GNI, section VI.4 for the methods, the transposed simplified Newton iteration as in radau_lanes.h).
 * Included by lanes.cc alone, once for each instruction set; this file must not use the C++ library.
 *
 * For the stages u_i, v_i of a step with F_i = F(t_i, u_i, v_i), K_i = dF_i/du, M_i = dF_i/dv and W = A^-1:
 *
 *   K_i^T mu_i + (1/h) sum_j W_ji M_j mu_j = -delta_is lambda,     lambda <- lambda + sum_i K_i^T mu_i,
 *
 * from the last step to the first; then dJ/dp = sum over steps and stages of mu_i . dF_i/dp. If J depends on the stages
 * themselves, a_j = dJ/du_j and c_j = dJ/dv_j, the right-hand side also has -a_j - (1/h) sum_i W_ij c_i, lambda also
 * + sum_i a_i, and dJ/dp its explicit parts.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Traverses the run of one body.
  template <int s>
  class AdjointSweep
  {
  public:
    AdjointSweep(const LaneSetup &setup, LaneAdjointHost *host, double *memory)
      : setup_(setup)
      , host_(host)
      , system_(setup)
      , n_(system_.n_unknowns)
      , stages_(setup, system_)
      , memory_(memory)
      , states_{setup, n_}
    {
      const std::size_t n = n_;
      states_.lay_out(memory_);
      stages_.lay_out(memory_);
      system_.lay_out(memory_);
      memory_.pieces(n, lambda_, zeta_, sources_.by_end);
      memory_.pieces(s * n, old_mu_, right_, sources_.by_u, sources_.by_velocity);
    }

    AdjointSweep(const AdjointSweep &) = delete;

    static std::size_t
    memory(const LaneSetup &setup)
    {
      return AdjointSweep(setup, nullptr, nullptr).memory_.size();
    }

    /// Returns false if the iteration for the stages of a step does not converge.
    bool
    run(const LaneBody &body, const LanePast &past)
    {
      system_.set_body(0, body);
      for (int d = 0; d < n_; ++d)
      {
        lambda_[d]   = past.gradient[d];
        states_.y[d] = past.end[d];
      }
      for (unsigned int step = past.n_steps; step-- > 0;)
      {
        const bool is_break = step + 1 == past.n_steps || past.starts[step + 1] != 0;
        load_step(past, step);
        if (past.has_sources)
          ask_for_sources(step);
        if (is_break)
          find_impulse();
        stages_.factorize(times_, states_, 1. / h_);
        guess(is_break ? 0. : past.sizes[step + 1]);
        if (!solve(past.has_sources))
          return false;
        for (int i = 0; i < s; ++i)
          for (int d = 0; d < n_; ++d)
          {
            const double own = stages_.K_mu[i * n_ + d];
            lambda_[d] += past.has_sources ? own + sources_.by_u[i * n_ + d] : own;
          }
        host_->step(step, stages_.mu, is_break ? zeta_ : nullptr);
        for (int i = 0; i < s * n_; ++i)
          old_mu_[i] = stages_.mu[i];
      }
      return true;
    }

  private:
    /// Loads the start of the step and its stages.
    void
    load_step(const LanePast &past, const unsigned int step)
    {
      h_              = past.sizes[step];
      const double *z = past.z + std::size_t(step) * s * n_;
      for (int d = 0; d < s * n_; ++d)
        states_.z[d] = z[d];
      for (int d = 0; d < n_; ++d)
        states_.y[d] -= z[(s - 1) * n_ + d];
      for (int i = 0; i < s; ++i)
        times_[i] = past.times[step] - (1. - setup_.method.c[i]) * h_;
    }

    /// Adds the sources of this step itself.
    void
    ask_for_sources(const unsigned int step)
    {
      for (int d = 0; d < n_; ++d)
        sources_.by_end[d] = 0.;
      for (int d = 0; d < s * n_; ++d)
        sources_.by_u[d] = sources_.by_velocity[d] = 0.;
      host_->sources(step, sources_);
      for (int d = 0; d < n_; ++d)
        lambda_[d] += sources_.by_end[d];
    }

    /// Solves M zeta = lambda for zeta where the body starts anew after the step, and at the end of the run. For so
    /// short a step the matrices of the systems are M.
    void
    find_impulse()
    {
      constexpr double inverse = 1. / 1e-14;
      states_.go_to_stage(s - 1, 1. / h_);
      system_.template factorize<true>(&times_[s - 1], states_.u, states_.v, nullptr, inverse);
      for (int d = 0; d < n_; ++d)
        zeta_[d] = (setup_.method.real_eigenvalue * inverse) * lambda_[d];
      system_.solve(zeta_);
    }

    bool
    solve(const bool has_sources)
    {
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
        {
          right_[i * n_ + d] = i + 1 < s ? 0. : -lambda_[d];
          if (!has_sources)
            continue;
          double sum = 0.;
          for (int j = 0; j < s; ++j)
            sum += setup_.method.inverse[j * s + i] * sources_.by_velocity[j * n_ + d];
          right_[i * n_ + d] -= sources_.by_u[i * n_ + d] + 1. / h_ * sum;
        }
      return stages_.solve(right_);
    }

    /// Guesses the adjoint zeta = -mu_i/(h b_i) by continuing that of the step after this one backwards, which has the
    /// size @p old_h; 0: by nothing.
    void
    guess(const double old_h)
    {
      const double ratio = h_ / old_h;
      const bool is_near = ratio <= radau::longest_extrapolation;
      for (int i = 0; i < s; ++i)
      {
        double weights[s] = {};
        for (int j = 0; j < s && is_near; ++j)
        {
          weights[j] = h_ * (1. / old_h) * (setup_.method.b[i] / setup_.method.b[j]);
          for (int k = 0; k < s; ++k)
            if (k != j)
              weights[j] *= ((setup_.method.c[i] - 1.) * ratio - setup_.method.c[k]) *
                            (1. / (setup_.method.c[j] - setup_.method.c[k]));
        }
        radau::combine(radau::Stages<s>{}, weights, old_mu_, n_, stages_.mu + i * n_);
      }
    }

    const LaneSetup &setup_;
    LaneAdjointHost *const host_;
    PositionSystem<double, (s - 1) / 2> system_;
    const int n_; ///< unknowns
    AdjointStages<s> stages_;
    LaneMemory memory_;
    LaneStates<double, s> states_;
    double h_ = 1.;
    double times_[s]; ///< times of the stages

    double *lambda_, *zeta_; ///< [unknown]
    double *old_mu_;         ///< [stage][unknown] of the following step
    double *right_;          ///< [stage][unknown] right-hand side
    LaneSources sources_{};
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
