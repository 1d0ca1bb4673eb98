// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/run/run_parameters.h>
#include <crawler/run/simulation.h>

#include <functional>

namespace crawler
{
  /**
   * Measures the error of a finished @p result, whose bound is known, once more by the adjoint (adjoint/error_sweep.h):
   * its parts in space and time, which were those that the rule of the numerics expects, and the corrected displacement
   * with its bound. A bound below the error found by the sweep is raised to it. Nothing is done where there is no
   * adjoint, and for runs of so many steps and cells that it would take long.
   */
  void
  sweep_error(const RunParameters &parameters,
              const Scene &scene,
              const NumericsChoice &choice,
              SimulationResult &result,
              const std::function<bool()> &keep_going);
} // namespace crawler
