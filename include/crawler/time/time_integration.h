// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/base/step_limits.h>
#include <crawler/base/words.h>

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace crawler
{
  /// An accepted step, as the monitor sees it.
  struct Step
  {
    double time;
    double size; ///< 0 for the initial state
    unsigned int number;
    bool is_output_time;   ///< the time is one of the times that were asked for, exactly
    unsigned int rejected; ///< rejected steps so far
    unsigned long newton_iterations;
  };

  /// How a computation ended.
  enum class Status
  {
    none, ///< it has not ended yet
    finished,
    inverted, ///< the body did, where the model ends
    failed,
    stopped ///< on request, by the monitor or a limit
  };
  template <>
  struct Words<Status>
  {
    static constexpr const char *list[] = {"", "finished", "inverted", "failed", "stopped"};
  };

  /// How a time integration ended.
  struct TimeOutcome
  {
    Status status = Status::none;
    std::string reason; ///< one of the names of doc/user_guide.md, empty if finished
    std::string message;
    bool domain_error  = false; ///< failed because every state tried was refused
    double time        = 0.;    ///< of the last accepted state
    double step_size   = 0.;    ///< that was tried last; if the monitor stopped: that would come next
    unsigned int steps = 0, rejected_steps = 0;
    unsigned long newton_iterations = 0, linear_iterations = 0;

    void
    exchange(Archive &archive)
    {
      archive(status, reason, message, domain_error, time, step_size);
      archive(steps, rejected_steps, newton_iterations, linear_iterations);
    }
  };

  /// Integrates a state over time: by PETSc (time_stepper.h) or by the fused engine (lanes/lane_stepper.h).
  class TimeIntegration
  {
  public:
    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;

    virtual ~TimeIntegration() = default;

    /// Sees the initial state and each accepted one; false stops the integration.
    std::function<bool(const Step &step, ConstVector y)> monitor;

    /// If set: sees the rates y' in the stages of each step before the monitor sees the step. PETSc shows those of
    /// every residual; the last one of a time counts.
    std::function<void(double time, ConstVector y_dot)> stage_rates;

    /**
     * Integrates from @p start_time to the end time. @p y is the first state on entry and the last accepted
     * state on return. Steps end exactly on @p output_times (ascending, within (start_time, end_time]) and on the end
     * time. The same object can solve again and again; that costs microseconds. @p tolerance [the unit of y] and @p
     * initial_step [time] replace the parameters' automatic values. Adaptive steps keep the @p limits.
     */
    virtual TimeOutcome
    solve(std::vector<double> &y,
          const std::vector<double> &output_times,
          double tolerance,
          double initial_step,
          std::span<const StepLimit> limits,
          double start_time) = 0;

    /// Within the monitor: the state at a time of the step that has just been accepted, by the integrator's own
    /// interpolation.
    virtual void
    interpolate(double time, Vector y) = 0;

    /**
     * All that solve() knows between two steps besides its arguments, if the integrator can tell. Written within the
     * monitor; read before a solve() with the same arguments, but with the state of then as @p y, which goes on from
     * there as if it had not been left. Returns false, and does nothing, if it cannot: then a run has to start anew at
     * that state.
     */
    virtual bool
    exchange(Archive &)
    {
      return false;
    }

    /// The stages of a collocation method, as parts of the step in (0, 1], the last one 1: what is integrated by the
    /// polynomial through them has the accuracy of the method. Empty if it is none.
    const std::vector<double> &
    stage_places() const
    {
      return stage_places_;
    }

  protected:
    std::vector<double> stage_places_;
  };
} // namespace crawler
