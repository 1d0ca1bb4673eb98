// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/adjoint/run_gradient.h>
#include <crawler/adjoint/works.h>
#include <crawler/studies/core/input.h>

#include <array>
#include <filesystem>
#include <functional>
#include <vector>

namespace crawler
{
  /// Keys in the result table of the numbers that are differentiated, in the order of all_quantities; the displacement
  /// is the first.
  inline constexpr std::array<const char *, all_quantities.size()> differentiated_numbers = {{"displacement",
                                                                                              "stress_power",
                                                                                              "dissipation",
                                                                                              "positive_power",
                                                                                              "paper_energy",
                                                                                              "gait.displacement",
                                                                                              "gait.speed"}};

  /// Step between answers with this relative error from which an entry is differentiated, relative to its value [1].
  double
  step_of_differences(double relative_error);

  /**
   * Adds the derivatives of displacement and works by @p entries, with the numerics of a finished run, to its @p
   * result, in the same order; their errors come from the derivatives with the numerics of the finer run. Where there
   * is no adjoint they are differences of answers. @p scene is the one of @p form. An entry
   * whose derivatives cannot be found has a reason instead. Returns where and when it matters, empty if that is not
   * known.
   */
  LocalSensitivity
  find_sensitivities(Form &form,
                     const Scene &scene,
                     const std::vector<SensitivityEntry> &entries,
                     const NumericsChoice &choice,
                     SimulationResult &result,
                     const std::function<bool()> &keep_going);

  /**
   * Adds the requested sensitivities (Input::sensitivities) of a finished run to its @p result,
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
