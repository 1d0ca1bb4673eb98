// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <optional>
#include <string>

namespace crawler
{
  class Declarations;

  /// Section "Time"; what is left empty is chosen from the wanted accuracy.
  struct TimeParameters
  {
    double end_time          = 1.;
    std::string integrator   = "automatic";
    std::string engine       = "automatic"; ///< or petsc: never the fused engine
    unsigned int order       = 5;
    std::string step_control = "adaptive";
    std::optional<double> tolerance;    ///< absolute, in the displacement [length]
    std::optional<double> initial_step; ///< [time]
    unsigned int max_steps = 100000000;
    std::string cycle_stop = "automatic";

    std::string petsc_prefix; ///< of PETSc's options; not an entry of the file

    void
    add_parameters(Declarations &declarations);

    /// Throws InputError if the entries do not fit together.
    void
    validate() const;
  };
} // namespace crawler
