// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// A time integrator that users can name.
  struct Integrator
  {
    std::string name;       ///< the word in the parameter file
    std::string petsc_type; ///< TSType
    unsigned int n_stages;  ///< implicit stages that are solved together
  };

  /// All integrators that are offered: each reaches its nominal order on M(u) u' = f (tests/convergence).
  const std::vector<Integrator> &
  integrators();

  /// "automatic" is bdf unless one is chosen (accuracy/numerics_choice.h). Throws std::logic_error if there is none
  /// of that name.
  const Integrator &
  integrator(const std::string &name);

  /// What is known against an integrator of PETSc (the word of `-ts_type`) for a mass matrix that depends on the state;
  /// empty if nothing is.
  std::string
  reason_against(const std::string &petsc_name);

  /// Is it one of integrators()? Only those have been verified.
  bool
  is_offered(const std::string &name);
} // namespace crawler
