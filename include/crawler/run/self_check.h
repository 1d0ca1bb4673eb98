// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/run/run_parameters.h>
#include <crawler/run/simulation.h>

namespace crawler
{
  /// Largest admissible EnergyBalance::residual() of a run.
  double
  energy_balance_tolerance(const SimulationResult &result, const RunParameters &parameters);

  /// Declares a finished run whose identities do not hold a failure: the energy balance must close, the friction forces
  /// balance, and the gait efficiency be at most 1 (doc/theory.md, "Gait efficiency"). A displacement of the stretch
  /// form that other meshes confirm stands without works if their energy residual exceeds a tenth, unless Output/Ledger
  /// tolerance is set.
  void
  check_identities(SimulationResult &result, const RunParameters &parameters);
} // namespace crawler
