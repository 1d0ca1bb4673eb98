// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/declarations.h>

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /// An entry that says whether others have an effect, and the values with which they have one. The chooser "crawler"
  /// is the command.
  struct Chooser
  {
    std::string path;
    std::function<bool(const std::string &value)> fits;

    bool
    is_command() const
    {
      return path == "crawler";
    }
  };

  /// The command of a run without files (from Python).
  inline const std::string run_in_memory_command = "run in memory";

  /// Entries, and sections with a "/" behind them, that have an effect only if one of the choosers fits. An entry needs
  /// all rules that name it or a section that it is in.
  struct EntryRule
  {
    std::vector<std::string> entries;
    std::vector<Chooser> choosers;
  };

  /// Those of the names in the entry @p constants that none of its formulas uses.
  std::vector<std::string>
  unused_constants(const Declarations &declarations, const EntryInfo &constants);

  /// Is the variable or constant @p name in the formula?
  bool
  uses_name(const std::string &formula, const std::string &name);

  /// The rules of all these entries: one without a rule always has an effect.
  std::vector<EntryRule>
  entry_rules(const Declarations &declarations);

  /// The rule by which this entry has no effect, if @p fits says which choosers fit; null if it has one.
  const EntryRule *
  rule_against(const std::vector<EntryRule> &rules,
               const std::string &path,
               const std::function<bool(const Chooser &)> &fits);
} // namespace crawler
