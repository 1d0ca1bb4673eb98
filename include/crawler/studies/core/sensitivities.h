// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/accuracy/numerics_choice.h>
#include <crawler/adjoint/run_gradient.h>
#include <crawler/studies/core/sensitivity_entries.h>

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /**
   * Adds the derivatives of displacement and works by @p entries, with the numerics of a finished run, to its @p
   * result, in the same order; their errors come from the derivatives with the numerics of the finer run. Where there
   * is no adjoint they are differences of answers (answer_differences.h). @p scene is the one of @p form. An entry
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
} // namespace crawler
