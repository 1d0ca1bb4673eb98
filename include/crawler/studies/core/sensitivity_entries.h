// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/form.h>

#include <string>
#include <vector>

namespace crawler
{
  /// An entry by which the numbers of a run are differentiated.
  struct SensitivityEntry
  {
    std::string path;
    double standard_deviation; ///< 0 if it is not uncertain
  };

  /// Those that Output/Sensitivities and Output/Uncertainty name, all of them numbers of the scene. Throws InputError.
  std::vector<SensitivityEntry>
  sensitivity_entries(const Form &form);
} // namespace crawler
