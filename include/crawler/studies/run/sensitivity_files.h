// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/adjoint/run_gradient.h>
#include <crawler/studies/core/input.h>

#include <filesystem>
#include <functional>

namespace crawler
{
  /**
   * Adds the requested sensitivities (Input::sensitivities, core/sensitivities.h) of a finished run to its @p result,
   * those of largest relative effect first; if all are requested, those without effect, and those that may not vary and
   * have their default, are left out. Returns where and when the run is sensitive, empty if that is not known.
   */
  LocalSensitivity
  add_sensitivities(const Input &input,
                    const NumericsChoice &choice,
                    SimulationResult &result,
                    const std::function<bool()> &keep_going);

  /// Writes sensitivity_body.csv and sensitivity_stress.csv, unless they would be empty. Throws FileError.
  void
  write_sensitivities(const LocalSensitivity &local, const std::filesystem::path &folder, const UnitNames &units);
} // namespace crawler
