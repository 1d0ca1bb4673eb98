// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/archive.h>
#include <crawler/time/implicit_system.h>
#include <crawler/time/petsc_guard.h>
#include <crawler/time/radau_tableau.h>

#include <petscts.h>

namespace crawler
{
  /// The TSType of the Radau IIA methods, known to PETSc after register_radau().
  constexpr const char *radau_type = "radau";

  /**
   * Registers the type: the one-step method for F(t, y, y') = 0 of order 2s-1 with s = 3 or 5 stages, an embedded error
   * estimate of order s, and the collocation polynomial as dense output and as first guess of the next step. The stages
   * are solved together by SNES; their system is preconditioned by one real and (s-1)/2 complex systems of the size of
   * y, to which it reduces where K and M are the same in all stages (Hairer and Wanner @cite HairerWanner1996, section
   * IV.8). `-ksp_type preonly` makes this the simplified Newton method, anything else a Newton-Krylov method, whose
   * products are renewed as the factors are.
   */
  PetscErrorCode
  register_radau();

  /// Sets the system, whose residual is that of TSSetIFunction. @p system and @p guard must outlive the stepper.
  const RadauTableau &
  radau_set_system(TS ts, ImplicitSystem *system, PetscGuard *guard);
  void
  radau_set_stages(TS ts, unsigned int n_stages);

  /// Exchanges the data that the type keeps between two steps besides the solution, for Stepper::exchange().
  void
  radau_exchange(TS ts, Archive &archive);
} // namespace crawler
