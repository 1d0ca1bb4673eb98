// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/time/time_integration.h>
#include <crawler/time/time_parameters.h>

#include <mpi.h>

#include <complex>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace crawler
{
  /**
   * Integrates F(t, y, y') = 0 with PETSc's TS, Newton's method by SNES, and KSP. It knows vectors and callbacks only,
   * no mesh. The callbacks have the names of dealii::PETScWrappers::TimeStepper of deal.II 9.6, which can replace this
   * class. Vectors are the owned values of each rank. An exception thrown by a callback ends solve() with it.
   *
   * Errors are controlled absolutely, with the root mean square of the estimated error of a step over all unknowns,
   * so y should be a displacement from rest. Newton's method stops when the estimated
   * remaining error is below 1% of that.
   */
  class TimeStepper : public TimeIntegration
  {
  public:
    /// @p n_owned: unknowns of this rank.
    TimeStepper(MPI_Comm communicator, std::size_t n_owned, const TimeParameters &parameters);
    ~TimeStepper() override;
    TimeStepper(const TimeStepper &) = delete;

    using Complex = std::complex<double>;

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
    /// Is solve_with_jacobian the inverse of jacobian_vmult? If not it preconditions a Krylov method, unless the user
    /// asks for another linear solver.
    bool exact_elimination = true;
    TimeOutcome
    solve(std::vector<double> &y,
          const std::vector<double> &output_times,
          double tolerance,
          double initial_step,
          std::span<const StepLimit> limits,
          double start_time) override;
    void
    interpolate(double time, Vector y) override;
    const std::vector<QuadraturePoint> &
    quadrature() const override;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace crawler
