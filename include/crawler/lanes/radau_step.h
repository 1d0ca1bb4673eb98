// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/lanes/lane_control.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/lanes/lane_memory.h>
#include <crawler/lanes/lane_states.h>

#include <cstddef>

/// Steps of a pack of bodies that are tried (included by radau_lanes.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  /// Stages of a step by the simplified Newton method, and the error of the step. @p System holds the equations of a
  /// form (lane_systems.h, lane_stretch.h).
  template <typename Pack, int s, typename System>
  struct RadauStep
  {
    static constexpr int lanes = PackTraits<Pack>::size, middle = s / 2;

    const LaneSetup &setup;
    System system;
    const int n, n_points; ///< unknowns, and points with an active stress
    LaneStates<Pack, s> states;
    Lane bodies[lanes];
    Pack tolerance, inverse_h;
    double times[s][lanes], start[lanes]; ///< times of the stages, and of the start of the step
    Pack *m, *m_start;                    ///< active stress of the stages, and at the start
    Pack *F;                              ///< [stage][unknown] residuals
    Pack *real;                           ///< [unknown] right-hand side of the real system, and its solution
    Complex<Pack> *complex;               ///< [pair][unknown] right-hand sides of the complex systems

    explicit RadauStep(const LaneSetup &all)
      : setup(all)
      , system(all)
      , n(system.n_unknowns)
      , n_points(system.n_points)
      , states{all, n}
    {
    }

    void
    lay_out(LaneMemory &memory)
    {
      const std::size_t unknowns = n;
      states.lay_out(memory);
      memory.pieces(s * unknowns, F);
      memory.pieces(std::size_t(s) * n_points, m);
      memory.pieces(n_points, m_start);
      memory.pieces(unknowns, real);
      memory.pieces((s - 1) / 2 * unknowns, complex);
      system.lay_out(memory);
    }

    /// Tries the step; each body says in its lane how this went.
    void
    make()
    {
      guess();
      states.go_to_stage(middle, inverse_h);
      system.factorize(times[middle], states.u, states.v, m + middle * n_points, inverse_h);
      newton();
      estimate_error();
    }

    void
    guess()
    {
      Pack begins{}, ratio{}, use{};
      for (int l = 0; l < lanes; ++l)
      {
        set_lane(begins, l, bodies[l].is_retry ? 0. : 1.);
        set_lane(ratio, l, bodies[l].h / bodies[l].old_h);
        set_lane(use, l, bodies[l].has_old);
      }
      states.guess(begins, ratio, use);
    }

    void
    newton()
    {
      for (Lane &lane : bodies)
        lane.start_newton();
      for (int it = 1; it <= max_newton && any(bodies, &Lane::iterating); ++it)
      {
        Pack least = broadcast<Pack>(HUGE_VAL);
        for (int i = 0; i < s; ++i)
        {
          states.go_to_stage(i, inverse_h);
          least = smaller(least, system.residual(times[i], states.u, states.v, m + i * n_points, F + i * n));
        }
        const Pack correction = correct();
        for (int l = 0; l < lanes; ++l)
          if (bodies[l].iterating)
            bodies[l].look_at_correction(
              it, get_lane(least, l), ::sqrt(get_lane(correction, l)), setup.method.newton_fraction);
      }
      for (Lane &lane : bodies)
        if (lane.iterating)
          lane.fail();
    }

    /// Square of the size of @p count elements in units of the tolerance.
    Pack
    relative(const Pack &square, const int count) const
    {
      const Pack in_units = square / (tolerance * tolerance);
      return System::largest ? in_units : in_units * (1. / count);
    }

    /// Makes one correction from the residuals F, in the basis of the eigenvectors of A^-1; returns its mean square in
    /// units of the tolerance. Lanes that are done keep their state.
    Pack
    correct()
    {
      Pack mask{};
      for (int l = 0; l < lanes; ++l)
        set_lane(mask, l, bodies[l].iterating);
      radau::to_eigenbasis(radau::Stages<s>{}, setup.method.rows, F, n, real, complex);
      system.solve(real, complex);
      const Pack square = states.template correct<System::largest>(real, complex, mask > 0.);
      return relative(square, s * n);
    }

    /// Estimates the error by the embedded formula, filtered as in time/radau.cc.
    void
    estimate_error()
    {
      states.go_to_start(inverse_h);
      for (int round = 0; round < 2; ++round)
      {
        system.residual(start, states.u, states.v, m_start, real);
        system.solve(real);
        const Pack square = relative(squared_size<System::largest>(real, system.n_controlled), n);
        for (int d = 0; d < n; ++d)
          states.u[d] = states.y[d] - real[d];
        bool again = false;
        for (int l = 0; l < lanes; ++l)
        {
          Lane &lane            = bodies[l];
          const double filtered = ::sqrt(get_lane(square, l));
          if (round == 0)
            lane.error = filtered;
          else if (lane.is_settling())
            lane.forbid_growth(filtered, s);
          again = again || (lane.busy && !lane.failed && lane.is_settling());
        }
        if (!again)
          break;
      }
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
