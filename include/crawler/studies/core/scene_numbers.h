// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/form.h>

#include <cmath>
#include <string>
#include <vector>

namespace crawler
{
  /// Number of the scene that a study varies.
  struct Variable
  {
    std::string path;
    double from, to, start; ///< range, and the value in the file [unit of the entry]
  };

  /// Variables that @p entry lists ("Optimize/Variables"). Throws InputError for it: names that are no numbers of the
  /// scene, empty or inadmissible ranges, values in the file outside of them.
  std::vector<Variable>
  read_variables(Form &form, const std::string &entry);

  /// Variables of a file; messages say where in it one is wrong.
  std::vector<Variable>
  read_variables(const ParameterFile &file, const std::string &entry);

  /// Entry by which the numbers of a run are differentiated.
  struct SensitivityEntry
  {
    std::string path;
    double deviation;     ///< standard deviation, in units of the entry or as a part of it; 0 if the entry is not
                          ///< uncertain
    bool is_part = false; ///< deviation is a part of the value of the entry

    double
    standard_deviation(const double value) const
    {
      return is_part ? deviation * std::abs(value) : deviation;
    }
  };

  /// Entries that Output/Sensitivities and Output/Uncertainty name, all of them numbers of the scene. Throws
  /// InputError.
  std::vector<SensitivityEntry>
  sensitivity_entries(const Form &form);
} // namespace crawler
