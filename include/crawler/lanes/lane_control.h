// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/instruction_set.h>
#include <crawler/lanes/lane_engine.h>
#include <crawler/time/radau_loops.h>

#include <cmath>

/// Decisions for each body alone: convergence of Newton's method and step sizes (included by radau_step.h).
namespace crawler::CRAWLER_INSTRUCTION_SET
{
  constexpr int max_newton = 14;
  /// Tolerance up to which the equations are solved at least.
  constexpr double largest_tolerance = 1e-3;
  /// Convergence rate of Newton's method, per iteration, above which the step is shortened by failure_factor.
  constexpr double slowest_rate = 0.5, failure_factor = 0.25;
  /// Convergence rate that no step is likely to exceed.
  constexpr double wanted_rate        = 0.35;
  constexpr unsigned int max_failures = 12;
  /// Failures of Newton's method, in number and as a part of the steps, beyond which a body is left to another engine.
  constexpr unsigned int many_failures = 1000;
  constexpr double large_part          = 0.5;
  /// Factor on the step after a rejected one.
  constexpr double after_rejection = 0.5;
  constexpr double min_step        = 1e-18; // a sudden start needs short ones

  /// Body in a lane, and its step.
  struct Lane : LaneProgress
  {
    LaneJob job;
    bool busy = false, is_idle = false;     ///< has a body; no body is left for it
    bool has_old = false, is_retry = false; ///< the guess has a step before; this is the failed try of a step
    bool iterating = false, failed = false, accepted = false;
    bool just_rejected        = false;
    unsigned int failures_now = 0;          ///< failures since the last accepted step
    double h                  = 1.;         ///< size of the step
    double rate = 0., last_correction = 0.; ///< convergence of Newton's method in the step
    double error = 0.;                      ///< error of the step, relative to the tolerance

    /// Takes the next body of a host, or one at rest that needs nothing.
    void
    take(LaneHost &host, const unsigned int lane)
    {
      *this   = Lane();
      busy    = host.take(lane, job);
      is_idle = !busy;
      if (is_idle)
        job = LaneJob();
      static_cast<LaneProgress &>(*this) = job.progress;
      has_old                            = job.old_z != nullptr;
    }

    /// Chooses the size of the step: the wanted one, but steps end at output times.
    void
    choose_step()
    {
      const double left = job.output_times[output_time] - t;
      h                 = admitted_step(job.limits, job.n_limits, limit, t, next);
      if (h >= left * (1. - 1e-9))
        h = left;
      else if (h > 0.5 * left)
        h = 0.5 * left;
    }

    double
    end_of_step() const
    {
      return h == job.output_times[output_time] - t ? job.output_times[output_time] : t + h;
    }

    void
    start_newton()
    {
      iterating = busy;
      failed    = false;
      rate      = 0.;
    }

    void
    fail()
    {
      failed    = true;
      iterating = false;
    }

    /// Checks the correction: Newton's method converges linearly; with the rate so far the remaining error is
    /// rate/(1-rate) corrections. @p correction and its admissible remainder @p newton_fraction are relative to the
    /// tolerance.
    void
    look_at_correction(const int it,
                       const double min_stretch_of_stages,
                       const double correction,
                       const double newton_fraction)
    {
      ++newton;
      if (!(min_stretch_of_stages > 0.) || !(correction < HUGE_VAL))
      {
        fail();
        return;
      }
      if (it == 1)
        known_rate = ::pow(known_rate, 0.8);
      else
      {
        rate       = last_correction > 0. ? correction / last_correction : 0.;
        known_rate = rate < 1e-6 ? 1e-6 : rate > 0.9 ? 0.9 : rate;
      }
      last_correction     = correction;
      const double excess = job.tolerance > largest_tolerance ? job.tolerance / largest_tolerance : 1.;
      const double likely = known_rate < 0.9 ? known_rate : 0.9;
      const double left   = likely / (1. - likely) * correction * excess;
      const double floor  = 1e-15 / job.tolerance; // of displacements up to 1: they are sums of numbers of this size
      if (left <= newton_fraction || correction <= floor)
        iterating = false;
      else if (it >= 2 && rate > slowest_rate && correction > 10. * floor)
        fail();
    }

    /// True if the error of the step must be filtered once more.
    bool
    is_settling() const
    {
      return error >= 1. && steps - first_step < radau::settling_steps;
    }

    /// Takes an error that was filtered twice; the step must not grow.
    void
    forbid_growth(const double filtered, const int n_stages)
    {
      const double least = radau::error_without_growth(n_stages);
      error              = filtered < least ? least : filtered;
    }

    /// Accepts or rejects the step, and finds the size of the next one. @p keeps_try: the result of Newton's method
    /// before it became too slow is the next guess, since it tells the direction of the friction.
    void
    control_step(const int n_stages, const bool keeps_try)
    {
      failed   = failed || !(error < HUGE_VAL); // the filter of the error lost the stretch
      accepted = !failed && error <= 1.;
      if (failed)
      {
        next    = failure_factor * h;
        has_old = is_retry = keeps_try && rate > 0. && rate < 1.; // the earlier guess was not good
        if (is_retry)
          old_h = h;
        ++failures_now;
        ++failures;
        ++rejected;
        return;
      }
      double factor = accepted || !just_rejected ? radau::safety : radau::safety * after_rejection;
      factor *= error > 0. ? ::pow(error, -1. / (n_stages + 1)) : HUGE_VAL;
      factor = factor < radau::min_change ? radau::min_change : factor > radau::max_change ? radau::max_change : factor;
      // Newton's method converges the more slowly the longer the step is, about in proportion. A step that was rejected
      // for its error is shortened all the same.
      if (accepted && rate > 0. && factor * rate > wanted_rate)
        factor = rate > wanted_rate ? 1. : wanted_rate / rate;
      next          = factor * h;
      just_rejected = !accepted;
      if (accepted)
        failures_now = 0;
      else
        ++rejected;
    }

    /// @p is_last_resort: no other engine can take over where Newton's method often fails.
    bool
    cannot_converge(const bool is_last_resort) const
    {
      return failures_now > max_failures || next < min_step ||
             (!is_last_resort && failures > many_failures && failures > large_part * steps);
    }

    /// Starts anew: from here on the past is no guide.
    void
    start_anew()
    {
      next          = job.initial_step;
      has_old       = false;
      is_retry      = false;
      just_rejected = false;
      known_rate    = 1.;
      first_step    = steps;
    }

    /// Advances to the end of the step; returns true if that is an output time.
    bool
    arrive()
    {
      t                         = end_of_step();
      old_h                     = h;
      has_old                   = true;
      is_retry                  = false;
      const bool is_output_time = t == job.output_times[output_time];
      ++steps;
      if (is_output_time)
        ++output_time;
      return is_output_time;
    }
  };
} // namespace crawler::CRAWLER_INSTRUCTION_SET
