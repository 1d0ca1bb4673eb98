// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_control.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_kernels.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_states.h>
#include <crawler/lanes/lane_stretch.h>
#include <crawler/lanes/lane_systems.h>

#include <cstddef>

/**
 * Radau IIA methods on packs of bodies; formulas and their sources are in doc/numerics.md, "Fused engine". Included by
 * lanes.cc alone, once for each instruction set. This file must not use the C++ library: its inline functions would be
 * compiled for this instruction set and might be used by all.
 */
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// @p System holds the equations of a form (lane_systems.h, lane_stretch.h).
  template <typename Pack, int s, template <typename, int> class System>
  class RadauLanes
  {
  public:
    static constexpr int lanes = PackTraits<Pack>::size, pairs = (s - 1) / 2, middle = s / 2;
    using Number = Complex<Pack>;

    /// @p host and @p setup must outlive it.
    RadauLanes(const LaneSetup &setup, const LaneHost &host, double *memory)
      : setup_(setup)
      , host_(host)
      , system_(setup, host)
      , n_(system_.n_unknowns())
      , n_points_(system_.n_points())
      , memory_(memory)
      , states_{setup, n_}
    {
      lay_out();
    }

    RadauLanes(const RadauLanes &) = delete;

    static std::size_t
    memory(const LaneSetup &setup)
    {
      const LaneHost none{};
      return own_size() + RadauLanes(setup, none, nullptr).memory_.size();
    }

    /// Constructs an engine at the beginning of @p memory, which holds all its data.
    static void
    start(const LaneSetup &setup, const LaneHost &host, double *memory)
    {
      new (memory) RadauLanes(setup, host, memory + own_size());
    }

    /// Tries a step of all bodies, after lanes that have none took one; false if there is none left.
    bool
    advance()
    {
      for (int l = 0; l < lanes; ++l)
        if (!lanes_[l].busy && !lanes_[l].is_idle)
          take_next(l);
      if (!any(lanes_, &Lane::busy))
        return false;
      if (friction_changed_)
        system_.sort_bodies();
      friction_changed_ = false;
      begin_step();
      guess();
      states_.go_to_stage(middle, inverse_h_);
      system_.factorize(times_[middle], states_.u, states_.v, m_ + middle * n_points_, inverse_h_);
      newton();
      estimate_error();
      decide();
      return true;
    }

  private:
    void
    lay_out()
    {
      const std::size_t n = n_;
      states_.lay_out(memory_);
      memory_.piece(F_, s * n);
      memory_.piece(m_, std::size_t(s) * n_points_);
      memory_.piece(m_start_, n_points_);
      memory_.piece(real_, n);
      memory_.piece(complex_, pairs * n);
      system_.lay_out(memory_);
      memory_.piece(scratch_, n_points_);
    }

    /// Takes the next body for a lane, or one at rest that needs nothing.
    void
    take_next(const int l)
    {
      Lane &lane   = lanes_[l];
      lane         = Lane();
      lane.busy    = host_.next(host_.context, static_cast<unsigned int>(l), lane.job);
      lane.is_idle = !lane.busy;
      if (lane.is_idle)
        lane.job = {1., 0., 1., 1., 1., nullptr, 0, 0, 0., false, 0., nullptr, nullptr, 0, nullptr};
      lane.t    = lane.job.start_time;
      lane.next = lane.job.initial_step;
      if (lane.job.progress != nullptr)
        static_cast<LaneProgress &>(lane) = *lane.job.progress;
      system_.set_body(l, lane.job, lane.busy);
      set_lane(tolerance_, l, lane.job.tolerance);
      friction_changed_ = true;
      states_.start(l, lane.job.start, lane.job.old_z);
      for (int i = 0; i < s * n_points_; ++i)
        set_lane(m_[i], l, 0.);
      stress(l, lane.t, m_start_);
    }

    void
    stress(const int l, const double t, Pack *m)
    {
      if (lanes_[l].busy)
        host_.stress(host_.context, static_cast<unsigned int>(l), t, scratch_);
      for (int i = 0; i < n_points_; ++i)
        set_lane(m[i], l, lanes_[l].busy ? scratch_[i] : 0.);
    }

    /// Sets lengths of the steps, and the active stress in their stages.
    void
    begin_step()
    {
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (lane.busy)
        {
          lane.choose_step();
          start_[l] = lane.t;
          for (int i = 0; i < s; ++i)
          {
            times_[i][l] = i + 1 < s ? lane.t + setup_.c[i] * lane.h : lane.end_of_step();
            stress(l, times_[i][l], m_ + i * n_points_);
          }
        }
        set_lane(inverse_h_, l, 1. / lane.h);
      }
    }

    void
    guess()
    {
      Pack start{}, ratio{}, use{};
      for (int l = 0; l < lanes; ++l)
      {
        set_lane(start, l, lanes_[l].is_retry ? 0. : 1.);
        set_lane(ratio, l, lanes_[l].h / lanes_[l].old_h);
        set_lane(use, l, lanes_[l].has_old);
      }
      states_.guess(start, ratio, use);
    }

    void
    newton()
    {
      for (Lane &lane : lanes_)
        lane.start_newton();
      for (int it = 1; it <= max_newton && any(lanes_, &Lane::iterating); ++it)
      {
        Pack least = broadcast<Pack>(HUGE_VAL);
        for (int i = 0; i < s; ++i)
        {
          states_.go_to_stage(i, inverse_h_);
          least = smaller(least, system_.residual(times_[i], states_.u, states_.v, m_ + i * n_points_, F_ + i * n_));
        }
        const Pack correction = correct();
        for (int l = 0; l < lanes; ++l)
          if (lanes_[l].iterating)
            lanes_[l].look_at_correction(it,
                                         get_lane(least, l),
                                         ::sqrt(get_lane(correction, l)),
                                         setup_.newton_fraction * lanes_[l].job.newton_factor);
      }
      for (Lane &lane : lanes_)
        if (lane.iterating)
          lane.fail();
    }

    /// Square of the size of @p n elements in units of the tolerance.
    Pack
    relative(const Pack &square, const int n) const
    {
      const Pack in_units = square / (tolerance_ * tolerance_);
      return System<Pack, pairs>::largest ? in_units : in_units * (1. / n);
    }

    /// Makes one correction from the residuals F, in the basis of the eigenvectors of A^-1; returns its mean square in
    /// units of the tolerance. Lanes that are done keep their state.
    Pack
    correct()
    {
      Pack mask{};
      for (int l = 0; l < lanes; ++l)
        set_lane(mask, l, lanes_[l].iterating);
      radau::to_eigenbasis(radau::Stages<s>{}, setup_.rows, F_, n_, real_, complex_);
      system_.solve_all(real_, complex_);
      const Pack square = states_.template correct<System<Pack, pairs>::largest>(real_, complex_, mask > 0.);
      return relative(square, s * n_);
    }

    /// Estimates the error by the embedded formula, filtered as in time/radau.cc.
    void
    estimate_error()
    {
      states_.go_to_start(inverse_h_);
      for (int round = 0; round < 2; ++round)
      {
        system_.residual(start_, states_.u, states_.v, m_start_, real_);
        system_.solve(real_);
        const Pack square = relative(squared_size<System<Pack, pairs>::largest>(real_, system_.n_controlled()), n_);
        for (int d = 0; d < n_; ++d)
          states_.u[d] = states_.y[d] - real_[d];
        bool again = false;
        for (int l = 0; l < lanes; ++l)
        {
          Lane &lane            = lanes_[l];
          const double filtered = ::sqrt(get_lane(square, l));
          if (round == 0)
            lane.error = filtered;
          else if (lane.is_settling())
            lane.settle(filtered, s);
          again = again || (lane.busy && !lane.failed && lane.is_settling());
        }
        if (!again)
          break;
      }
    }

    /// Accepts or rejects steps, and finds the next ones.
    void
    decide()
    {
      Pack accepted{}, tried{};
      bool any = false, any_tried = false;
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = lanes_[l];
        if (!lane.busy)
          continue;
        lane.control_step(s, System<Pack, pairs>::keeps_tries && (setup_.laws & LaneLaws::nonlinear_in_velocity) != 0);
        set_lane(accepted, l, lane.accepted);
        any = any || lane.accepted;
        set_lane(tried, l, lane.failed && lane.is_retry);
        any_tried = any_tried || (lane.failed && lane.is_retry);
      }
      if (any_tried)
        states_.keep_try(tried > 0.);
      if (any)
        advance(accepted > 0.);
      for (int l = 0; l < lanes; ++l)
        if (lanes_[l].busy && !lanes_[l].accepted && lanes_[l].is_hopeless())
          end(l, LaneOutcome::gave_up);
    }

    /// Advances the accepted lanes to the ends of their steps.
    void
    advance(const typename PackTraits<Pack>::Mask &accepted)
    {
      if (host_.look_inside)
        for (int i = 0; i + 1 < s; ++i)
        {
          states_.go_to_stage(i, inverse_h_);
          look_at_stage(i, states_.u);
        }
      states_.go_to_end(accepted);
      for (int i = 0; i < n_points_; ++i)
        m_start_[i] = accepted ? m_[(s - 1) * n_points_ + i] : m_start_[i];
      if constexpr (System<Pack, pairs>::gives_rates)
        if (host_.look_inside) // the velocity of the stage has the error of Newton's method
        {
          states_.go_to_rate(s - 1, inverse_h_);
          unsettled_ = system_.velocity(times_[s - 1], states_.y, m_ + (s - 1) * n_points_, states_.v, real_);
        }
      look_at_stage(s - 1, states_.y);
      for (int l = 0; l < lanes; ++l)
        if (lanes_[l].busy && lanes_[l].accepted)
          arrive(l);
    }

    /// Keeps the stretch, and the rates if they are requested, of a stage with the state (@p u, v).
    void
    look_at_stage(const int i, const Pack *u)
    {
      LaneLook<Pack> look;
      system_.look(times_[i], u, states_.v, m_ + i * n_points_, host_.look_inside, look);
      const LaneIntegrals<Pack> &sums = look.sums;
      for (int l = 0; l < lanes; ++l)
        stages_[l][i] = {get_lane(look.least, l),
                         get_lane(look.most, l),
                         static_cast<unsigned int>(get_lane(look.min_at, l)),
                         static_cast<unsigned int>(get_lane(look.max_at, l)),
                         get_lane(sums.stress_power, l),
                         get_lane(sums.positive_power, l),
                         get_lane(sums.absolute_power, l),
                         get_lane(sums.dissipation, l),
                         get_lane(sums.net_friction, l),
                         get_lane(sums.abs_friction, l),
                         get_lane(states_.v[0], l),
                         get_lane(states_.v[n_ - 1], l),
                         {get_lane(look.end_stretch[0], l), get_lane(look.end_stretch[1], l)},
                         {get_lane(look.end_rate[0], l), get_lane(look.end_rate[1], l)}};
      elastic_energy_ = sums.elastic_energy;
    }

    /// Handles a lane at the end of its step.
    void
    arrive(const int l)
    {
      Lane &lane                = lanes_[l];
      const bool is_output_time = lane.arrive();
      if (!(stages_[l][s - 1].min_stretch > lane.job.least_stretch))
      {
        end(l, LaneOutcome::gave_up);
        return;
      }
      bool go_on = true;
      if (host_.accepted != nullptr)
        go_on = host_.accepted(host_.context,
                               static_cast<unsigned int>(l),
                               {lane.t,
                                lane.h,
                                lane.next,
                                lane.steps,
                                lane.rejected,
                                lane.newton,
                                is_output_time,
                                lanes,
                                reinterpret_cast<const double *>(states_.y) + l,
                                reinterpret_cast<const double *>(states_.old_z) + l,
                                stages_[l],
                                get_lane(elastic_energy_, l),
                                get_lane(unsettled_, l) <= 1e3,
                                &lane});
      if (lane.output_time == lane.job.n_output_times)
        end(l, LaneOutcome::finished);
      else if (!go_on || lane.steps >= lane.job.max_steps)
        end(l, LaneOutcome::stopped);
      else if (is_output_time && lane.job.restarts != nullptr && lane.job.restarts[lane.output_time - 1] != 0)
      {
        lane.start_anew();
        stress(l, lane.t, m_start_);
      }
    }

    void
    end(const int l, const LaneOutcome::Status status)
    {
      const Lane &lane = lanes_[l];
      host_.done(
        host_.context,
        static_cast<unsigned int>(l),
        {status, lane.t, lane.next, lane.steps, lane.rejected, lane.newton, get_lane(system_.integral(states_.y), l)});
      lanes_[l].busy = false;
    }

    /// Number of doubles of the object itself.
    static std::size_t
    own_size()
    {
      return (sizeof(RadauLanes) + 63) / 64 * 8;
    }

    static void *
    operator new(std::size_t, void *place)
    {
      return place;
    }

    const LaneSetup &setup_;
    const LaneHost &host_;
    System<Pack, pairs> system_;
    const int n_, n_points_; ///< unknowns, and points with an active stress
    LaneMemory memory_;
    LaneStates<Pack, s> states_;
    Lane lanes_[lanes];
    Pack tolerance_, inverse_h_;
    double times_[s][lanes], start_[lanes]; ///< times of the stages, and of the start of the step
    bool friction_changed_ = true;
    LaneStage stages_[lanes][s]; ///< stages as the host sees them
    Pack elastic_energy_{};
    Pack unsettled_{}; ///< error of the velocity at the end of the step, relative to the requested one

    Pack *F_;            ///< [stage][unknown] residuals
    Pack *real_;         ///< [unknown] right-hand side of the real system, and its solution
    Number *complex_;    ///< [pair][unknown] right-hand sides of the complex systems
    Pack *m_, *m_start_; ///< active stress of the stages, and at the start
    double *scratch_;    ///< active stress of one lane
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
