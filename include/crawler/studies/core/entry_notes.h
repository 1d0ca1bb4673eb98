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
  /// What a study fills in: entries that have other values than those of the file, and the entry that says so.
  struct VariedEntries
  {
    std::vector<std::string> paths = {};
    std::string by                 = "";
    bool may_be_all                = false; ///< whole files are filled in
  };

  /// What the program has chosen where the file says "automatic", by the paths of the entries.
  using ChosenValues = std::map<std::string, std::string>;

  /// A note for each entry that @p file changes, or an axis varies, without an effect in @p command (entry_rules.h),
  /// one for all that it changes in a section without an effect; and for each list that may be meant as a decimal.
  std::vector<std::string>
  notes_on_entries(const ParameterFile &file,
                   const Declarations &declarations,
                   const std::string &command,
                   const VariedEntries &varied = {},
                   const ChosenValues &chosen  = {});

  /// "0,5" where a single number would do is a list of two, but most likely meant as 0.5; so is a comma without a space
  /// in a list whose others have one.
  std::vector<std::string>
  notes_on_decimal_commas(const ParameterFile &file, const Declarations &declarations);

  /// Adds notes on entries of @p file that have no effect in this scene, whatever the others are, unless these
  /// @p notes have the entry already.
  void
  add_notes_on_scene(const ParameterFile &file,
                     const RunParameters &parameters,
                     const Scene &scene,
                     std::vector<std::string> &notes);
} // namespace crawler
