// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/form.h>

#include <string>
#include <vector>

namespace crawler
{
  /// A number of the scene that an optimisation varies.
  struct OptimizeVariable
  {
    std::string path;
    double from, to, start; ///< range, and the value in the file [unit of the entry]
  };

  /// Those of Optimize/Variables. Throws InputError for it: names that are no numbers of the scene, empty or
  /// inadmissible ranges, values in the file outside of them, and an objective without maximum: one that no limit
  /// holds.
  std::vector<OptimizeVariable>
  read_variables(Form &form);

  /// The scene with these values. Throws InputError.
  Parameters
  parameters_at(Form &form, const std::vector<OptimizeVariable> &variables, const std::vector<double> &x);

  /// The values where start @p number begins: those of the file for the first, others at random about them.
  std::vector<double>
  start_values(const OptimizeParameters &parameters,
               const std::vector<OptimizeVariable> &variables,
               unsigned long number);
} // namespace crawler
