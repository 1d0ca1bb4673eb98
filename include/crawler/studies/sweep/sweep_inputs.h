// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/sweep/sweep_points.h>

#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// Inputs on which the answers of a sweep depend, kept with them as attributes of the table (JSON).
  struct SweepInputs
  {
    std::string effective;                                            ///< the parameter file, without comments
    std::map<std::string, std::map<std::string, std::string>> scenes; ///< for each file on the file axis, the entries
                                                                      ///< whose values differ from effective
    std::map<std::string, std::string> files; ///< fingerprints of the files that entries name (one process reads them)

    /// Attributes "parameters.prm", "scene files" and "data files".
    std::map<std::string, std::string>
    attributes() const;

    /// Inverse of attributes(). Throws InputError if @p attributes are not of that form.
    static SweepInputs
    from_attributes(const std::map<std::string, std::string> &attributes);
  };

  /// Inputs of a sweep that is about to begin (one process: reads the files). Throws FileError.
  SweepInputs
  sweep_inputs(const SweepPoints &points);

  /// Changes of the inputs, each in a few words, except in the entries for the amount of computation (@p free_entries).
  std::vector<std::string>
  differences(const SweepInputs &before, const SweepInputs &now, const std::vector<std::string> &free_entries);
} // namespace crawler
