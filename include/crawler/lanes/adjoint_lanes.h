// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_kernels.h>
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
    static constexpr int lanes = PackTraits<Pack>::size, pairs = (s - 1) / 2, middle = s / 2, max_directions = 12;
    using Number = Complex<Pack>;

    AdjointLanes(const LaneSetup &setup, const LaneAdjointHost &host, double *memory)
      : setup_(setup)
      , host_(host)
      , laws_host_{host.context, nullptr, nullptr, nullptr, nullptr, false, host.laws}
      , system_(setup, laws_host_)
      , n_(system_.n_unknowns())
      , n_points_(system_.n_points())
      , memory_(memory)
      , states_{setup, n_}
    {
      lay_out();
      constexpr int columns = 1 + pairs;
      for (int i = 0; i < s; ++i)
        for (int j = 0; j < columns; ++j)
          for (int part = 0; part < 2; ++part)
          {
            rows_[2 * (j * s + i) + part]          = setup.vectors[2 * (i * columns + j) + part];
            vectors_[2 * (i * columns + j) + part] = setup.rows[2 * (j * s + i) + part];
          }
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
        if (friction_changed_)
          system_.sort_bodies();
        friction_changed_ = false;
        load_step();
        ask_for_sources();
        look_at_break();
        look_at_stages();
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
      bool busy = false, iterating = false, failed = false, has_old = false, at_break = false;
      unsigned int left = 0; ///< steps left, including this one
      double h = 1., old_h = 1., last_change = 0.;
    };

    void
    lay_out()
    {
      const std::size_t n = n_, points = n_points_;
      states_.lay_out(memory_);
      memory_.piece(lambda_, n);
      memory_.piece(zeta_, n);
      memory_.piece(mu_, s * n);
      memory_.piece(old_mu_, s * n);
      memory_.piece(K_mu_, s * n);
      memory_.piece(M_mu_, s * n);
      memory_.piece(residual_, s * n);
      memory_.piece(directions_, 2 * max_directions * s * n);
      memory_.piece(by_u_, s * n);
      memory_.piece(by_velocity_, s * n);
      memory_.piece(real_, n);
      memory_.piece(complex_, pairs * n);
      for (LaneSlopes<Pack> &slopes : slopes_)
        system_.lay_out(slopes, points, memory_);
      system_.lay_out(memory_);
      memory_.piece(scratch_, (1 + 2 * s) * n);
    }

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
      friction_changed_ = true;
      for (int d = 0; d < n_; ++d)
      {
        set_lane(lambda_[d], l, lane.busy ? lane.past.gradient[d] : 0.);
        set_lane(states_.y[d], l, lane.busy ? lane.past.end[d] : 0.);
      }
      for (int d = 0; d < s * n_; ++d)
        set_lane(states_.z[d], l, 0.);
      if (lane.busy && lane.left == 0)
        end(l);
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
    look_at_stages()
    {
      for (int i = 0; i < s; ++i)
      {
        states_.go_to_stage(i, inverse_h_);
        system_.slopes(times_[i], states_.u, states_.v, slopes_[i]);
      }
      states_.go_to_stage(middle, inverse_h_);
      system_.template factorize<true>(times_[middle], states_.u, states_.v, nullptr, inverse_h_);
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
        radau::combine(radau::Stages<s>{}, weights, old_mu_, n_, mu_ + i * n_);
      }
    }

    /// Multiplies K_i^T x_i and M_i x_i.
    void
    multiply(const Pack *x)
    {
      for (int i = 0; i < s; ++i)
        system_.transposed(slopes_[i], x + i * n_, K_mu_ + i * n_, M_mu_ + i * n_);
    }

    /// Left-hand side of the equations for the stages.
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
          result[i * n_ + d] = K_mu_[i * n_ + d] + inverse_h_ * sum;
        }
    }

    /// Evaluates the residual of the equations for the stages.
    void
    look_at_residual()
    {
      apply(mu_, residual_);
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
        {
          Pack right = i + 1 < s ? Pack{} : -lambda_[d];
          if (has_sources_)
          {
            Pack sum{};
            for (int j = 0; j < s; ++j)
              sum += setup_.inverse[j * s + i] * by_velocity_[j * n_ + d];
            right -= by_u_[i * n_ + d] + inverse_h_ * sum;
          }
          residual_[i * n_ + d] = right - residual_[i * n_ + d];
        }
    }

    /// Solves for the stages of the adjoint by generalized conjugate residuals (Eisenstat, Elman, Schultz, SIAM J.
    /// Numer. Anal. 20 (1983) 345) with the transposed systems of simplified Newton; that iteration alone may not
    /// converge where the steps are long.
    void
    solve()
    {
      constexpr int max_passes = 100;
      for (Lane &lane : lanes_)
      {
        lane.iterating   = lane.busy;
        lane.failed      = false;
        lane.last_change = HUGE_VAL;
      }
      n_directions_ = 0;
      look_at_residual();
      for (int pass = 0; pass < max_passes && any(lanes_, &Lane::iterating); ++pass)
      {
        const bool settles = correct();
        if (settles || n_directions_ == max_directions)
        {
          look_at_residual();
          n_directions_ = 0;
        }
      }
      for (Lane &lane : lanes_)
      {
        lane.failed    = lane.iterating;
        lane.iterating = false;
      }
      multiply(mu_);
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
      system_.solve_all(real_, complex_);
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
        mu_[d] += moved;
        change = added<true>(change, moved < 0. ? -moved : moved);
        size   = added<true>(size, mu_[d] < 0. ? -mu_[d] : mu_[d]);
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

    void
    finish_step()
    {
      Pack busy{};
      for (int l = 0; l < lanes; ++l)
        set_lane(busy, l, lanes_[l].busy && !lanes_[l].failed);
      const auto counts = busy > 0.;
      for (int i = 0; i < s; ++i)
        for (int d = 0; d < n_; ++d)
        {
          const Pack more = has_sources_ ? K_mu_[i * n_ + d] + by_u_[i * n_ + d] : K_mu_[i * n_ + d];
          lambda_[d]      = counts ? lambda_[d] + more : lambda_[d];
        }
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (!lane.busy)
          continue;
        --lane.left;
        if (!lane.failed)
          host_.step(host_.context,
                     static_cast<unsigned int>(l),
                     {lane.left,
                      lanes,
                      reinterpret_cast<const double *>(mu_) + l,
                      lane.at_break ? reinterpret_cast<const double *>(zeta_) + l : nullptr});
        lane.old_h   = lane.h;
        lane.has_old = lane.past.starts == nullptr || lane.past.starts[lane.left] == 0;
        if (lane.failed || lane.left == 0)
          end(l);
      }
      for (int i = 0; i < s * n_; ++i)
        old_mu_[i] = mu_[i];
    }

    void
    end(const int l)
    {
      host_.done(host_.context,
                 static_cast<unsigned int>(l),
                 !lanes_[l].failed,
                 lanes,
                 reinterpret_cast<const double *>(lambda_) + l);
      take_next(l);
    }

    const LaneSetup &setup_;
    const LaneAdjointHost &host_;
    const LaneHost laws_host_;
    PositionSystem<Pack, pairs> system_;
    const int n_, n_points_; ///< unknowns, and quadrature points
    LaneMemory memory_;
    LaneStates<Pack, s> states_;
    Lane lanes_[lanes];
    Pack inverse_h_;
    double times_[s][lanes]; ///< times of the stages
    bool friction_changed_ = true;
    double rows_[2 * (1 + pairs) * s], vectors_[2 * (1 + pairs) * s]; ///< eigenvectors of the transposed A^-1
    LaneSlopes<Pack> slopes_[s];                                      ///< slopes at the stages

    Pack *lambda_, *zeta_;                   ///< [unknown]
    Pack *mu_, *old_mu_;                     ///< [stage][unknown] of this step, and of the following one
    Pack *K_mu_, *M_mu_, *residual_, *real_; ///< products, and right-hand sides in both bases
    Pack *directions_;                       ///< [direction][stage][unknown], then their images under the equations
    int n_directions_ = 0;
    Pack *by_u_, *by_velocity_; ///< [stage][unknown] sources
    double *scratch_;           ///< scratch of one lane
    bool has_sources_ = false;
    Number *complex_;
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
