// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/form.h>

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
} // namespace crawler
