// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/declarations.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/run/run_parameters.h>

#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// Entries whose values a study replaces, and the entry that says so.
  struct VariedEntries
  {
    std::vector<std::string> paths = {};
    std::string by                 = "";
    bool may_be_all                = false; ///< true if whole files are replaced
  };

  /// Choices of the program where the file says "automatic", by the paths of the entries.
  using ChosenValues = std::map<std::string, std::string>;

  /// Notes on entries that @p file changes, or an axis varies, without effect in @p command (entry_rules.h), a single
  /// note for all entries changed in a section without effect; and on lists that may be meant as a decimal.
  std::vector<std::string>
  notes_on_entries(const ParameterFile &file,
                   const Declarations &declarations,
                   const std::string &command,
                   const VariedEntries &varied = {},
                   const ChosenValues &chosen  = {});

  /// Notes on "0,5" where a single number would do: a list of two, but most likely meant as 0.5; likewise on a comma
  /// without a space in a list with spaces behind its other commas.
  std::vector<std::string>
  notes_on_decimal_commas(const ParameterFile &file, const Declarations &declarations);

  /// Adds notes on entries of @p file that have no effect in this scene, whatever the other entries are, unless @p
  /// notes has them already.
  void
  add_notes_on_scene(const ParameterFile &file,
                     const RunParameters &parameters,
                     const Scene &scene,
                     std::vector<std::string> &notes);
} // namespace crawler
