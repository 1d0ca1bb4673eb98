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
   * The sensitivities that are wanted (Input::sensitivities, core/sensitivities.h) of a finished run into its
   * @p result, those that matter most first; of all those that have no effect, or may not vary from where they are by
   * default, are left out. Returns where and when it matters, empty if that is not known.
   */
  LocalSensitivity
  add_sensitivities(const Input &input,
                    const NumericsChoice &choice,
                    SimulationResult &result,
                    const std::function<bool()> &keep_going);

  /// Writes sensitivity_body.csv and sensitivity_stress.csv, as far as there is something in them. Throws FileError.
  void
  write_sensitivities(const LocalSensitivity &local, const std::filesystem::path &folder, const UnitNames &units);
} // namespace crawler
