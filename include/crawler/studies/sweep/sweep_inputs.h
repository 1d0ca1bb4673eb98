// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/sweep/sweep_points.h>

#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// Inputs on which the answers of a sweep depend, kept with them as attributes of the table: "parameters.prm",
  /// without comments; as JSON "scene files", for each file on the file axis the entries whose values differ from
  /// these, and "data files", the fingerprints of the files that entries name.
  using SweepInputs = std::map<std::string, std::string>;

  /// Inputs of a sweep that is about to begin (one process: reads the files). Throws FileError.
  SweepInputs
  sweep_inputs(const SweepPoints &points);

  /// Changes of the inputs, each in a few words, except in the entries for the amount of computation (@p free_entries).
  /// Inputs that are missing are empty. Throws InputError if those of the table are damaged.
  std::vector<std::string>
  differences(const SweepInputs &before, const SweepInputs &now, const std::vector<std::string> &free_entries);
} // namespace crawler
