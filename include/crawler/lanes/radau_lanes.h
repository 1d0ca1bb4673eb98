// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_stretch.h>
#include <crawler/lanes/lane_systems.h>
#include <crawler/lanes/radau_step.h>

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
    static constexpr int lanes = PackTraits<Pack>::size;
    using Equations            = System<Pack, (s - 1) / 2>;

    /// @p host and @p setup must outlive it.
    RadauLanes(const LaneSetup &setup, LaneHost *host, double *memory)
      : setup_(setup)
      , host_(host)
      , step_(setup)
      , memory_(memory)
    {
      step_.lay_out(memory_);
      memory_.pieces(step_.n_points, scratch_);
    }

    RadauLanes(const RadauLanes &) = delete;

    static std::size_t
    memory(const LaneSetup &setup)
    {
      return own_size() + RadauLanes(setup, nullptr, nullptr).memory_.size();
    }

    /// Constructs an engine at the beginning of @p memory, which holds all its data.
    static void
    start(const LaneSetup &setup, LaneHost *host, double *memory)
    {
      new (memory) RadauLanes(setup, host, memory + own_size());
    }

    /// Tries a step of all bodies, after lanes that have none took one; false if there is none left.
    bool
    advance()
    {
      for (int l = 0; l < lanes; ++l)
        if (!step_.bodies[l].busy && !step_.bodies[l].is_idle)
          take_next(l);
      if (!any(step_.bodies, &Lane::busy))
        return false;
      begin_step();
      step_.make();
      decide();
      return true;
    }

  private:
    /// Takes the next body for a lane.
    void
    take_next(const int l)
    {
      Lane &lane = step_.bodies[l];
      lane.take(*host_, l);
      step_.system.set_body(l, lane.job.body);
      set_lane(step_.tolerance, l, lane.job.tolerance);
      step_.states.start(l, lane.job.start, lane.job.old_z);
      for (int i = 0; i < s * step_.n_points; ++i)
        set_lane(step_.m[i], l, 0.);
      stress(l, lane.t, step_.m_start);
    }

    void
    stress(const int l, const double t, Pack *m)
    {
      if (step_.bodies[l].busy)
        host_->stress(l, t, scratch_);
      for (int i = 0; i < step_.n_points; ++i)
        set_lane(m[i], l, step_.bodies[l].busy ? scratch_[i] : 0.);
    }

    /// Sets lengths of the steps, and the active stress in their stages.
    void
    begin_step()
    {
      for (int l = 0; l < lanes; ++l)
      {
        Lane &lane = step_.bodies[l];
        if (lane.busy)
        {
          lane.choose_step();
          step_.start[l] = lane.t;
          for (int i = 0; i < s; ++i)
          {
            step_.times[i][l] = i + 1 < s ? lane.t + setup_.method.c[i] * lane.h : lane.end_of_step();
            stress(l, step_.times[i][l], step_.m + i * step_.n_points);
          }
        }
        set_lane(step_.inverse_h, l, 1. / lane.h);
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
        Lane &lane = step_.bodies[l];
        if (!lane.busy)
          continue;
        lane.control_step(s, Equations::keeps_tries && (setup_.laws & LaneLaws::nonlinear_in_velocity) != 0);
        set_lane(accepted, l, lane.accepted);
        any = any || lane.accepted;
        set_lane(tried, l, lane.failed && lane.is_retry);
        any_tried = any_tried || (lane.failed && lane.is_retry);
      }
      if (any_tried)
        step_.states.keep_try(tried > 0.);
      if (any)
        advance(accepted > 0.);
      for (int l = 0; l < lanes; ++l)
        if (step_.bodies[l].busy && !step_.bodies[l].accepted && step_.bodies[l].cannot_converge(setup_.is_stretch))
          end(l, LaneOutcome::gave_up);
    }

    /// Advances the accepted lanes to the ends of their steps.
    void
    advance(const typename PackTraits<Pack>::Mask &accepted)
    {
      if (host_->look_inside)
        for (int i = 0; i + 1 < s; ++i)
        {
          step_.states.go_to_stage(i, step_.inverse_h);
          look_at_stage(i, step_.states.u);
        }
      step_.states.go_to_end(accepted);
      for (int i = 0; i < step_.n_points; ++i)
        step_.m_start[i] = accepted ? step_.m[(s - 1) * step_.n_points + i] : step_.m_start[i];
      if constexpr (Equations::gives_rates)
        if (host_->look_inside) // the velocity of the stage has the error of Newton's method
        {
          step_.states.go_to_rate(s - 1, step_.inverse_h);
          unsettled_ = step_.system.velocity(
            step_.times[s - 1], step_.states.y, step_.m + (s - 1) * step_.n_points, step_.states.v, step_.real);
        }
      look_at_stage(s - 1, step_.states.y);
      for (int l = 0; l < lanes; ++l)
        if (step_.bodies[l].busy && step_.bodies[l].accepted)
          arrive(l);
    }

    /// Keeps the stretch, and the rates if they are requested, of a stage with the state (@p u, v).
    void
    look_at_stage(const int i, const Pack *u)
    {
      LaneLook<Pack> look;
      step_.system.look(step_.times[i], u, step_.states.v, step_.m + i * step_.n_points, host_->look_inside, look);
      const LaneIntegrals<Pack> &sums = look.sums;
      for (int l = 0; l < lanes; ++l)
        stages_[l][i] = {get_lane(look.stretch.least, l),
                         get_lane(look.stretch.most, l),
                         static_cast<unsigned int>(get_lane(look.stretch.min_at, l)),
                         static_cast<unsigned int>(get_lane(look.stretch.max_at, l)),
                         get_lane(sums.elastic_energy, l),
                         get_lane(sums.stress_power, l),
                         get_lane(sums.positive_power, l),
                         get_lane(sums.absolute_power, l),
                         get_lane(sums.dissipation, l),
                         get_lane(sums.net_friction, l),
                         get_lane(sums.abs_friction, l),
                         get_lane(step_.states.v[0], l),
                         get_lane(step_.states.v[step_.n - 1], l),
                         {get_lane(look.end_stretch[0], l), get_lane(look.end_stretch[1], l)},
                         {get_lane(look.end_rate[0], l), get_lane(look.end_rate[1], l)}};
    }

    /// Handles a lane at the end of its step.
    void
    arrive(const int l)
    {
      Lane &lane                = step_.bodies[l];
      const bool is_output_time = lane.arrive();
      if (!(stages_[l][s - 1].min_stretch > lane.job.least_stretch))
      {
        end(l, LaneOutcome::gave_up);
        return;
      }
      const bool go_on = host_->accepted(l,
                                         {lane.t,
                                          lane.h,
                                          is_output_time,
                                          lanes,
                                          reinterpret_cast<const double *>(step_.states.y) + l,
                                          reinterpret_cast<const double *>(step_.states.old_z) + l,
                                          stages_[l],
                                          get_lane(unsettled_, l) <= 1e3,
                                          &lane});
      if (lane.output_time == lane.job.n_output_times)
        end(l, LaneOutcome::finished);
      else if (!go_on || lane.steps >= lane.job.max_steps)
        end(l, LaneOutcome::stopped);
      else if (is_output_time && lane.job.restarts != nullptr && lane.job.restarts[lane.output_time - 1] != 0)
      {
        lane.start_anew();
        stress(l, lane.t, step_.m_start);
      }
    }

    void
    end(const int l, const LaneOutcome::Status status)
    {
      host_->done(l, {status, &step_.bodies[l]});
      step_.bodies[l].busy = false;
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
    LaneHost *const host_;
    RadauStep<Pack, s, Equations> step_;
    LaneMemory memory_;
    LaneStage stages_[lanes][s]; ///< stages as the host sees them
    Pack unsettled_{};           ///< error of the velocity at the end of the step, relative to the requested one
    double *scratch_;            ///< active stress of one lane
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
