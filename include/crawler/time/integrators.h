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
    std::string subtype;    ///< of arkimex
    unsigned int order;     ///< nominal order; 0: the entry "Order" decides (bdf)
    bool adaptive;          ///< has an error estimate
  };

  /// All integrators that are offered: each reaches its nominal order on M(u) u' = f (tests/convergence).
  const std::vector<Integrator> &
  integrators();

  /// Throws std::logic_error if there is none of that name.
  const Integrator &
  integrator(const std::string &name);

  /// Why an integrator of PETSc (the word of `-ts_type`, "arkimex TYPE" or "theta endpoint") must not be used for a
  /// mass matrix that depends on the state; empty for those that are offered. What was not tried is refused too.
  std::string
  reason_against(const std::string &petsc_name);
} // namespace crawler
