// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include "run_text.h"

#include <crawler/studies/core/compute.h>

#include <cmath>
#include <exception>

namespace crawler::test
{
  /// Interrupts nothing.
  inline bool
  never()
  {
    return false;
  }

  /// Computes what `crawler run` does, without files.
  inline Answer
  computed(const Parameters &parameters)
  {
    Task task;
    task.parameters = parameters;
    task.gait       = true;
    compute_all({&task, 1}, HUGE_VAL, never);
    if (task.error)
      std::rethrow_exception(task.error);
    return task.computed;
  }

  inline Answer
  computed(const Settings &settings)
  {
    return computed(parameters_with(settings));
  }

  inline SimulationResult
  answer_to(const Settings &settings)
  {
    return computed(settings).result;
  }
} // namespace crawler::test
