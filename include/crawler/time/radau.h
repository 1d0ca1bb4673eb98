// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <petscts.h>

#include <complex>
#include <functional>
#include <span>

namespace crawler
{
  /**
   * What the Radau IIA methods need besides TSSetIFunction: systems with K + sigma M, K = dF/dy and M = dF/dy', on
   * owned values, and products with K and M. All return PETSc error codes.
   */
  struct RadauSystems
  {
    using Complex     = std::complex<double>;
    using ConstVector = std::span<const double>;

    /// Factorizes K + real_sigma M and K + sigma_i M at a state; @p ok tells whether none of them is singular.
    std::function<PetscErrorCode(
      double t, ConstVector y, ConstVector y_dot, double real_sigma, std::span<const Complex> sigma, bool &ok)>
      setup;
    std::function<PetscErrorCode(ConstVector b, std::span<double> x)> solve_real;
    std::function<PetscErrorCode(unsigned int i, std::span<const Complex> b, std::span<Complex> x)> solve_complex;
    /// Keeps K and M at the state of a stage, and result = K x + M x_dot with them.
    std::function<PetscErrorCode(unsigned int stage, double t, ConstVector y, ConstVector y_dot)> setup_stage;
    std::function<PetscErrorCode(unsigned int stage, ConstVector x, ConstVector x_dot, std::span<double> result)>
      multiply_stage;
  };

  /// The TSType of the Radau IIA methods, known to PETSc after register_radau().
  constexpr const char *radau_type = "radau";

  /**
   * Registers the type: a one-step method for F(t, y, y') = 0 of order 2s-1 with s = 3 or 5 stages, an embedded error
   * estimate of order s, and the collocation polynomial as dense output and as first guess of the next step. The
   * stages are solved together by SNES; their system is preconditioned by one real and (s-1)/2 complex systems of the
   * size of y, to which it reduces where K and M are the same in all stages (Hairer and Wanner, Solving Ordinary
   * Differential Equations II, section IV.8). `-ksp_type preonly` makes this the simplified Newton method, anything
   * else a Newton-Krylov method with exact products.
   */
  PetscErrorCode
  register_radau();

  /// @p systems must outlive the stepper.
  PetscErrorCode
  radau_set_systems(TS ts, const RadauSystems *systems);
  PetscErrorCode
  radau_set_stages(TS ts, unsigned int n_stages);
  PetscErrorCode
  radau_get_stages(TS ts, unsigned int *n_stages);
} // namespace crawler
