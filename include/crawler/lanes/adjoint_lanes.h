// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/adjoint_stages.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_states.h>
#include <crawler/lanes/lane_systems.h>

#include <cstddef>

/**
 * Discrete adjoint of the Radau IIA methods on packs of bodies (doc/numerics.md, "Sensitivities"; Hairer, Hochbruck,
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
  template <typename Pack, int s>
  class AdjointLanes
  {
  public:
    static constexpr int lanes = PackTraits<Pack>::size;

    AdjointLanes(const LaneSetup &setup, const LaneAdjointHost &host, double *memory)
      : setup_(setup)
      , host_(host)
      , laws_host_{host.context, nullptr, nullptr, nullptr, nullptr, false, host.laws}
      , system_(setup, laws_host_)
      , n_(system_.n_unknowns())
      , stages_(setup, system_)
      , memory_(memory)
      , states_{setup, n_}
    {
      const std::size_t n = n_;
      states_.lay_out(memory_);
      stages_.lay_out(memory_);
      system_.lay_out(memory_);
      memory_.pieces(n, lambda_, zeta_);
      memory_.pieces(s * n, old_mu_, right_, by_u_, by_velocity_);
      memory_.pieces((1 + 2 * s) * n, scratch_);
    }

    AdjointLanes(const AdjointLanes &) = delete;

    static std::size_t
    memory(const LaneSetup &setup)
    {
      const LaneAdjointHost none{};
      return AdjointLanes(setup, none, nullptr).memory_.size();
    }

    void
    run()
    {
      for (int l = 0; l < lanes; ++l)
        take_next(l);
      while (any(lanes_, &Lane::busy))
      {
        load_step();
        ask_for_sources();
        look_at_break();
        stages_.factorize(times_, states_, inverse_h_);
        guess();
        solve();
        finish_step();
      }
    }

  private:
    /// Body and the step that is traversed.
    struct Lane
    {
      LanePast past;
      bool busy = false, has_old = false, at_break = false;
      unsigned int left = 0; ///< steps left, including this one
      double h = 1., old_h = 1.;
    };

    /// Takes the next body for a lane, or one at rest that needs nothing.
    void
    take_next(const int l)
    {
      Lane &lane = lanes_[l];
      lane       = Lane();
      LaneJob job{};
      lane.busy = host_.next(host_.context, static_cast<unsigned int>(l), job, lane.past);
      if (!lane.busy)
        job.k = 1.;
      lane.left = lane.past.n_steps;
      system_.set_body(l, job, lane.busy);
      for (int d = 0; d < n_; ++d)
      {
        set_lane(lambda_[d], l, lane.busy ? lane.past.gradient[d] : 0.);
        set_lane(states_.y[d], l, lane.busy ? lane.past.end[d] : 0.);
      }
      for (int d = 0; d < s * n_; ++d)
        set_lane(states_.z[d], l, 0.);
      if (lane.busy && lane.left == 0)
        end(l, true);
    }

    /// Loads the start of the step and its stages.
    void
    load_step()
    {
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (lane.busy)
        {
          const std::size_t step = lane.left - 1;
          lane.h                 = lane.past.sizes[step];
          const double *z        = lane.past.z + step * s * n_;
          for (int d = 0; d < s * n_; ++d)
            set_lane(states_.z[d], l, z[d]);
          for (int d = 0; d < n_; ++d)
            set_lane(states_.y[d], l, get_lane(states_.y[d], l) - z[(s - 1) * n_ + d]);
          for (int i = 0; i < s; ++i)
            times_[i][l] = lane.past.times[step] - (1. - setup_.c[i]) * lane.h;
        }
        set_lane(inverse_h_, l, 1. / lane.h);
      }
    }

    /// Adds the sources of this step itself.
    void
    ask_for_sources()
    {
      has_sources_ = false;
      for (int l = 0; l < lanes; ++l)
      {
        const Lane &lane = lanes_[l];
        if (!lane.busy || !lane.past.has_sources)
          continue;
        if (!has_sources_)
          for (int d = 0; d < s * n_; ++d)
            by_u_[d] = by_velocity_[d] = Pack{};
        has_sources_ = true;
        for (int d = 0; d < (1 + 2 * s) * n_; ++d)
          scratch_[d] = 0.;
        const LaneSources sources = {scratch_, scratch_ + n_, scratch_ + (1 + s) * n_};
        host_.sources(host_.context, static_cast<unsigned int>(l), lane.left - 1, sources);
        for (int d = 0; d < n_; ++d)
          set_lane(lambda_[d], l, get_lane(lambda_[d], l) + sources.by_end[d]);
        for (int d = 0; d < s * n_; ++d)
        {
          set_lane(by_u_[d], l, sources.by_u[d]);
          set_lane(by_velocity_[d], l, sources.by_velocity[d]);
        }
      }
    }

    /// Solves M zeta = lambda for zeta where a body starts anew after the step, and at the end of the run. For so short
    /// a step the matrices of the systems are M.
    void
    look_at_break()
    {
      constexpr double tiny_step = 1e-14;
      bool any                   = false;
      for (Lane &lane : lanes_)
      {
        lane.at_break = lane.busy && (lane.left == lane.past.n_steps ||
                                      (lane.past.starts != nullptr && lane.past.starts[lane.left] != 0));
        any           = any || lane.at_break;
      }
      if (!any)
        return;
      states_.go_to_stage(s - 1, inverse_h_);
      const Pack inverse = broadcast<Pack>(1. / tiny_step);
      system_.template factorize<true>(times_[s - 1], states_.u, states_.v, nullptr, inverse);
      for (int d = 0; d < n_; ++d)
        zeta_[d] = (setup_.real_eigenvalue * inverse) * lambda_[d];
      system_.solve(zeta_);
    }

    void
    solve()
    {
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
        {
          right_[i * n_ + d] = i + 1 < s ? Pack{} : -lambda_[d];
          if (!has_sources_)
            continue;
          Pack sum{};
          for (int j = 0; j < s; ++j)
            sum += setup_.inverse[j * s + i] * by_velocity_[j * n_ + d];
          right_[i * n_ + d] -= by_u_[i * n_ + d] + inverse_h_ * sum;
        }
      stages_.solve(right_, [this](const int l) { return lanes_[l].busy; });
    }

    /// Guesses the adjoint zeta = -mu_i/(h b_i) by continuing that of the step after this one backwards.
    void
    guess()
    {
      Pack ratio{}, use{}, old_inverse_h{}, h{};
      for (int l = 0; l < lanes; ++l)
      {
        const Lane &lane   = lanes_[l];
        const double times = lane.h / lane.old_h;
        set_lane(ratio, l, times);
        set_lane(use, l, lane.has_old && times <= radau::longest_extrapolation ? 1. : 0.);
        set_lane(old_inverse_h, l, 1. / lane.old_h);
        set_lane(h, l, lane.h);
      }
      for (int i = 0; i < s; ++i)
      {
        Pack weights[s];
        for (int j = 0; j < s; ++j)
        {
          weights[j] = use * h * old_inverse_h * (setup_.b[i] / setup_.b[j]);
          for (int k = 0; k < s; ++k)
            if (k != j)
              weights[j] *= ((setup_.c[i] - 1.) * ratio - setup_.c[k]) * (1. / (setup_.c[j] - setup_.c[k]));
        }
        radau::combine(radau::Stages<s>{}, weights, old_mu_, n_, stages_.mu + i * n_);
      }
    }

    void
    finish_step()
    {
      Pack busy{};
      for (int l = 0; l < lanes; ++l)
        set_lane(busy, l, lanes_[l].busy && !stages_.has_failed(l));
      const auto counts = busy > 0.;
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
        {
          const Pack more = has_sources_ ? stages_.K_mu[i * n_ + d] + by_u_[i * n_ + d] : stages_.K_mu[i * n_ + d];
          lambda_[d]      = counts ? lambda_[d] + more : lambda_[d];
        }
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (!lane.busy)
          continue;
        --lane.left;
        const bool failed = stages_.has_failed(l);
        if (!failed)
          host_.step(host_.context,
                     static_cast<unsigned int>(l),
                     {lane.left,
                      lanes,
                      reinterpret_cast<const double *>(stages_.mu) + l,
                      lane.at_break ? reinterpret_cast<const double *>(zeta_) + l : nullptr});
        lane.old_h   = lane.h;
        lane.has_old = lane.past.starts == nullptr || lane.past.starts[lane.left] == 0;
        if (failed || lane.left == 0)
          end(l, !failed);
      }
      for (int i = 0; i < s * n_; ++i)
        old_mu_[i] = stages_.mu[i];
    }

    void
    end(const int l, const bool finished)
    {
      host_.done(
        host_.context, static_cast<unsigned int>(l), finished, lanes, reinterpret_cast<const double *>(lambda_) + l);
      take_next(l);
    }

    const LaneSetup &setup_;
    const LaneAdjointHost &host_;
    const LaneHost laws_host_;
    PositionSystem<Pack, (s - 1) / 2> system_;
    const int n_; ///< unknowns
    AdjointStages<Pack, s> stages_;
    LaneMemory memory_;
    LaneStates<Pack, s> states_;
    Lane lanes_[lanes];
    Pack inverse_h_;
    double times_[s][lanes]; ///< times of the stages
    bool has_sources_ = false;

    Pack *lambda_, *zeta_;      ///< [unknown]
    Pack *old_mu_;              ///< [stage][unknown] of the following step
    Pack *right_;               ///< [stage][unknown] right-hand side
    Pack *by_u_, *by_velocity_; ///< [stage][unknown] sources
    double *scratch_;           ///< scratch of one lane
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
