// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// A time integrator that users can choose by name.
  struct Integrator
  {
    std::string name;       ///< the word in the parameter file
    std::string petsc_type; ///< TSType
    unsigned int n_stages;  ///< implicit stages solved together
  };

  /// All offered integrators: each reaches its nominal order on M(u) u' = f (tests/convergence).
  const std::vector<Integrator> &
  integrators();

  /// Integrator of this name. Throws std::logic_error if there is none.
  const Integrator &
  integrator(const std::string &name);

  /// Known objection to an integrator of PETSc (the word of `-ts_type`) for a mass matrix that depends on the state;
  /// empty if there is none.
  std::string
  reason_against(const std::string &petsc_name);

  /// True for integrators(); only those have been verified.
  bool
  is_offered(const std::string &name);
} // namespace crawler
