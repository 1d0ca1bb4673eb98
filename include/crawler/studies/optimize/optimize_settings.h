// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/variables.h>

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// Those of Optimize/Variables. Throws InputError as read_variables() does, and for an objective without maximum: one
  /// that no limit holds.
  std::vector<Variable>
  read_variables_of_gait(Form &form);

  /// An entry that limits gaits, and its value if it is set.
  struct LimitEntry
  {
    std::string name;
    std::optional<double> value;
  };

  /// All of them, in the order in which results name them.
  std::vector<LimitEntry>
  limits_of(const OptimizeParameters &parameters);

  /// The scene with these values. Throws InputError.
  Parameters
  parameters_at(Form &form, const std::vector<Variable> &variables, const std::vector<double> &x);

  /// The values where start @p number begins: those of the file for the first, others at random about them.
  std::vector<double>
  start_values(const OptimizeParameters &parameters, const std::vector<Variable> &variables, unsigned long number);
} // namespace crawler
