// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/sweep/sweep_points.h>

#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// What the answers of a sweep depend on, to be kept with them: attributes of the table (JSON).
  struct SweepInputs
  {
    std::string effective;                                            ///< the parameter file, without comments
    std::map<std::string, std::map<std::string, std::string>> scenes; ///< of each file on the file axis the entries
                                                                      ///< that have other values than in effective
    std::map<std::string, std::string> files; ///< fingerprints of the files that entries name (one process reads them)

    /// As attributes "parameters.prm", "scene files" and "data files".
    std::map<std::string, std::string>
    attributes() const;

    /// Throws InputError if they are not what attributes() gives.
    static SweepInputs
    from_attributes(const std::map<std::string, std::string> &attributes);
  };

  /// Those of a sweep that is about to begin (one process: reads the files). Throws FileError.
  SweepInputs
  sweep_inputs(const SweepPoints &points);

  /// What has changed, each in a few words, but for the entries that say how much is computed and not what
  /// (@p free_entries).
  std::vector<std::string>
  differences(const SweepInputs &before, const SweepInputs &now, const std::vector<std::string> &free_entries);
} // namespace crawler
