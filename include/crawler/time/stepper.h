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
    bool is_output_time;   ///< exactly one of the requested times
    unsigned int rejected; ///< rejected steps so far
    unsigned long newton_iterations;

    void
    exchange(auto &archive)
    {
      archive(time, size, number, is_output_time, rejected, newton_iterations);
    }
  };

  /// Outcome of a computation.
  enum class Status
  {
    none, ///< not ended yet
    finished,
    inverted, ///< the body inverted, where the model ends
    failed,
    stopped ///< on request, or by a limit
  };
  template <>
  inline constexpr const char *words_of<Status>[] = {"", "finished", "inverted", "failed", "stopped"};

  /// Outcome of a time integration.
  struct TimeOutcome
  {
    Status status = Status::none;
    std::string reason; ///< a name of doc/user_guide.md, empty if finished
    std::string message;
    bool domain_error  = false; ///< failed because every attempted state was refused
    double time        = 0.;    ///< of the last accepted state
    double step_size   = 0.;    ///< last attempted; without a status: the next one
    unsigned int steps = 0, rejected_steps = 0;
    unsigned long newton_iterations = 0;

    void
    exchange(Archive &archive)
    {
      archive(status, reason, message, domain_error, time, step_size, steps, rejected_steps, newton_iterations);
    }
  };

  /// An integration over time: its start, ends and tolerance.
  struct Course
  {
    double start;                      ///< [time]
    std::vector<double> ends;          ///< ascending times where steps end exactly; the last is the end of the course
    double tolerance;                  ///< of the error of a step [the unit of y]
    double initial_step;               ///< [time]
    std::span<const StepLimit> limits; ///< of adaptive steps; must outlive the integration
  };

  /// Integrates a state over time, step by step: by PETSc (petsc_stepper.h) or the fused engine (lanes/lane_stepper.h).
  class Stepper
  {
  public:
    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;

    virtual ~Stepper() = default;

    /// Called, if set, with the rates y' in the stages of each step before next() returns it. PETSc passes those of
    /// every residual; the last one of a time counts.
    std::function<void(double time, ConstVector y_dot)> stage_rates;

    /// Starts from the state @p y. One object can begin repeatedly, which takes microseconds.
    virtual void
    begin(ConstVector y, const Course &course) = 0;

    /// Makes the next step; null at the end of the course, or if no step is possible. Throws what the system throws.
    virtual const Step *
    next() = 0;

    /// State after the last step.
    virtual ConstVector
    state() const = 0;

    /// Outcome of the integration; without a status if it has not ended. The counts are those since begin().
    virtual TimeOutcome
    outcome() = 0;

    /// Interpolates the state at a time within the last step by the integrator's own method.
    virtual void
    interpolate(double time, Vector y) = 0;

    /**
     * Exchanges all data kept between two steps besides the course. After reading, begin() with the same course, but
     * with the state at the writing as y, continues as if never interrupted. Returns false, and does nothing, if the
     * integrator cannot: then a run has to restart at that state.
     */
    virtual bool
    exchange(Archive &)
    {
      return false;
    }

    /// Stages of a collocation method, as fractions of the step in (0, 1], the last one 1: integrals of the polynomial
    /// through them have the accuracy of the method. Empty for other methods.
    const std::vector<double> &
    stage_places() const
    {
      return stage_places_;
    }

  protected:
    std::vector<double> stage_places_;
  };
} // namespace crawler
