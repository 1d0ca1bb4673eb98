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
  /// An accepted step.
  struct Step
  {
    double time;
    double size; ///< 0 for the initial state
    unsigned int number;
    bool is_output_time;   ///< the time is one of the times that were asked for, exactly
    unsigned int rejected; ///< rejected steps so far
    unsigned long newton_iterations;

    void
    exchange(auto &archive)
    {
      archive(time, size, number, is_output_time, rejected, newton_iterations);
    }
  };

  /// How a computation ended.
  enum class Status
  {
    none, ///< it has not ended yet
    finished,
    inverted, ///< the body did, where the model ends
    failed,
    stopped ///< on request, or by a limit
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
    double step_size   = 0.;    ///< that was tried last; without a status: that would come next
    unsigned int steps = 0, rejected_steps = 0;
    unsigned long newton_iterations = 0, linear_iterations = 0;

    void
    exchange(Archive &archive)
    {
      archive(status, reason, message, domain_error, time, step_size);
      archive(steps, rejected_steps, newton_iterations, linear_iterations);
    }
  };

  /// An integration over time: where it starts and ends, and how exact it is.
  struct Course
  {
    double start;                      ///< [time]
    std::vector<double> ends;          ///< ascending times behind it where steps end exactly; the last one is the end
    double tolerance;                  ///< of the error of a step [the unit of y]
    double initial_step;               ///< [time]
    std::span<const StepLimit> limits; ///< of adaptive steps; must outlive the integration
  };

  /// Integrates a state over time, step by step: by PETSc (petsc_stepper.h) or by the fused engine
  /// (lanes/lane_stepper.h).
  class Stepper
  {
  public:
    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;

    virtual ~Stepper() = default;

    /// If set: sees the rates y' in the stages of each step before next() returns it. PETSc shows those of every
    /// residual; the last one of a time counts.
    std::function<void(double time, ConstVector y_dot)> stage_rates;

    /// Starts from the state @p y. The same object can begin again and again; that costs microseconds.
    virtual void
    begin(ConstVector y, const Course &course) = 0;

    /// Makes the next step; null at the end of the course, or if there is none. Throws what the system throws.
    virtual const Step *
    next() = 0;

    /// Behind the last step that was made.
    virtual ConstVector
    state() const = 0;

    /// How the integration ended; without a status if it did not. The counts are those since begin().
    virtual TimeOutcome
    outcome() = 0;

    /// The state at a time of the last step, by the integrator's own interpolation.
    virtual void
    interpolate(double time, Vector y) = 0;

    /**
     * All that is known between two steps besides the course. Read before begin() with the same course, but with the
     * state of then as y, which goes on from there as if it had not been left. Returns false, and does nothing, if the
     * integrator cannot tell: then a run has to start anew at that state.
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
