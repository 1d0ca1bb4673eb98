// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/drivers/parameters.h>
#include <crawler/drivers/simulation.h>

namespace crawler
{
  /// The largest admissible Ledger::residual() of a run.
  double
  ledger_tolerance(const SimulationResult &result, const Parameters &parameters);

  /// Names a finished run whose identities do not hold a failure: the ledger must close, the friction forces balance.
  void
  check_identities(SimulationResult &result, const Parameters &parameters);
} // namespace crawler
