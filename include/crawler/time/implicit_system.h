// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <complex>
#include <cstddef>
#include <span>

namespace crawler
{
  /**
   * A system F(t, y, y') = 0 with y' implicit, as the integrators of PETSc see it: residual, Newton's linear systems,
   * and products with the Jacobian. Vectors are the owned values of each rank; all functions are collective. An
   * exception that one of them throws ends the integration.
   */
  class ImplicitSystem
  {
  public:
    using Vector      = std::span<double>;
    using ConstVector = std::span<const double>;
    using Complex     = std::complex<double>;

    virtual ~ImplicitSystem() = default;

    /// Number of unknowns of this rank.
    virtual std::size_t
    n_owned() const = 0;

    /// Computes F = F(t, y, y_dot); false (on all ranks) refuses a state outside of the domain of F: the step is
    /// repeated smaller.
    virtual bool
    residual(double t, ConstVector y, ConstVector y_dot, Vector F) = 0;

    /// Prepares dF/dy + sigma dF/dy_dot for the two functions below; false if it is singular.
    virtual bool
    setup_jacobian(double t, ConstVector y, ConstVector y_dot, double sigma) = 0;
    virtual void
    solve_with_jacobian(ConstVector b, Vector x) = 0;
    virtual void
    jacobian_vmult(ConstVector x, Vector y) = 0;

    /// True if solve_with_jacobian() is the inverse of jacobian_vmult(). If not, it preconditions a Krylov method.
    virtual bool
    solves_exactly() const
    {
      return true;
    }

    /// Prepares dF/dy + sigma dF/dy_dot for complex sigma_0, sigma_1, ... of the Radau methods.
    virtual bool
    setup_complex_jacobians(double t, ConstVector y, ConstVector y_dot, std::span<const Complex> sigma) = 0;
    virtual void
    solve_with_complex_jacobian(unsigned int i, std::span<const Complex> b, std::span<Complex> x) = 0;

    /// Keeps dF/dy and dF/dy_dot at the state of a stage, for a Krylov method with the Radau methods; then result =
    /// dF/dy x + dF/dy_dot x_dot.
    virtual void
    setup_stage(unsigned int stage, double t, ConstVector y, ConstVector y_dot) = 0;
    virtual void
    stage_vmult(unsigned int stage, ConstVector x, ConstVector x_dot, Vector result) = 0;
  };
} // namespace crawler
