// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/studies/core/input.h>

#include <filesystem>
#include <functional>

namespace crawler
{
  /**
   * The derivatives of the displacement by the entries that are wanted (Input::sensitivities), with the numerics of a
   * finished run, into its @p result; their errors from the same with the numerics of the finer run. Writes
   * sensitivity_body.csv and sensitivity_stress.csv. An entry whose derivative cannot be found has a reason instead.
   */
  void
  find_sensitivities(const Input &input,
                     const NumericsChoice &choice,
                     const std::filesystem::path &folder,
                     SimulationResult &result,
                     const std::function<bool()> &keep_going);
} // namespace crawler
