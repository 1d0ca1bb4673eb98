// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/time/time_parameters.h>

#include <mpi.h>

#include <complex>
#include <functional>
#include <limits>
#include <memory>
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
    bool is_frame;         ///< the time is one of the times that were asked for, exactly
    unsigned int rejected; ///< rejected steps so far
    unsigned long newton_iterations;
  };

  /// How a time integration ended.
  struct TimeOutcome
  {
    /// finished, stopped (by the monitor or the step limit) or failed
    std::string status;
    std::string reason; ///< one of the names of doc/user_guide.md, empty if finished
    std::string message;
    bool domain_error  = false; ///< failed because implicit_function refused every state tried
    double time        = 0.;    ///< of the last accepted state
    double step_size   = 0.;    ///< that was tried last; if the monitor stopped: that would come next
    unsigned int steps = 0, rejected_steps = 0;
    unsigned long newton_iterations = 0, linear_iterations = 0;
  };

  /**
   * Integrates F(t, y, y') = 0 with PETSc's TS, Newton's method by SNES, and KSP. It knows vectors and callbacks only,
   * no mesh. The callbacks have the names of dealii::PETScWrappers::TimeStepper of deal.II 9.6, which can replace this
   * class. Vectors are the owned values of each rank. An exception thrown by a callback ends solve() with it.
   *
   * Errors are controlled absolutely, with the root mean square of the estimated error of a step over all unknowns,
   * each divided by its weight, so y should be a displacement from rest. Newton's method stops when the estimated
   * remaining error is below 1% of that.
   */
  class TimeStepper
  {
  public:
    /// @p weights: for each owned unknown the error that counts as much as an error of 1 in the displacement.
    TimeStepper(MPI_Comm communicator, const std::vector<double> &weights, const TimeParameters &parameters);
    ~TimeStepper();
    TimeStepper(const TimeStepper &) = delete;

    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;
    using Complex     = std::complex<double>;

    /// residual = F(t, y, y_dot); false refuses the state (outside of the domain of F): the step is tried again
    /// smaller.
    std::function<bool(double t, ConstVector y, ConstVector y_dot, Vector residual)> implicit_function;
    /// Prepares dF/dy + alpha dF/dy_dot for the two functions below; false if it is singular.
    std::function<bool(double t, ConstVector y, ConstVector y_dot, double alpha)> setup_jacobian;
    std::function<void(ConstVector source, Vector destination)> solve_with_jacobian;
    std::function<void(ConstVector source, Vector destination)> jacobian_vmult;
    /// For the Radau methods: the same for complex alpha_0, alpha_1, ...
    std::function<bool(double t, ConstVector y, ConstVector y_dot, std::span<const Complex> alpha)>
      setup_complex_jacobians;
    std::function<void(unsigned int i, std::span<const Complex> source, std::span<Complex> destination)>
      solve_with_complex_jacobian;
    /// And, if the linear solver is a Krylov method: keeps dF/dy and dF/dy_dot at the state of a stage; then
    /// destination = dF/dy x + dF/dy_dot x_dot.
    std::function<void(unsigned int stage, double t, ConstVector y, ConstVector y_dot)> setup_stage;
    std::function<void(unsigned int stage, ConstVector x, ConstVector x_dot, Vector destination)> stage_vmult;
    /// Has F derivatives everywhere? If not, Newton's method goes on until a second correction is small.
    bool smooth = true;
    /// Sees the initial state and each accepted one; false stops the integration.
    std::function<bool(const Step &step, ConstVector y)> monitor;

    /**
     * Integrates from @p start_time to parameters.end_time. @p y is the first state on entry and the last accepted
     * state on return. Steps end exactly on @p frames (ascending, within (start_time, end_time]) and on the end time.
     * The same object can solve again and again; that costs microseconds. @p tolerance [the unit of y] and @p
     * initial_step [time] replace the parameters' automatic values. No adaptive step is longer than @p largest_step.
     */
    TimeOutcome
    solve(std::vector<double> &y,
          const std::vector<double> &frames,
          double tolerance,
          double initial_step,
          double largest_step = std::numeric_limits<double>::infinity(),
          double start_time   = 0.);

    /// Within the monitor: the state at a time of the step that has just been accepted, by the integrator's own
    /// interpolation.
    void
    interpolate(double time, Vector y);

    /// The formula by which the integrator itself integrates over a step: states interpolated at these parts of the
    /// step, in (0, 1], have the accuracy of the method. Empty if it is not known.
    struct QuadraturePoint
    {
      double place, weight;
    };
    const std::vector<QuadraturePoint> &
    quadrature() const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace crawler
