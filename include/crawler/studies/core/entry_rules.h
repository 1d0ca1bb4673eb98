// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/declarations.h>

#include <functional>
#include <string>
#include <vector>

namespace crawler
{
  /// Entry that decides whether others have an effect, and the values with which they have one. The chooser "crawler"
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

  /// Command of a run without files (from Python).
  inline const std::string run_in_memory_command = "run in memory";

  /// Entries, and sections with a trailing "/", that have an effect only if one of the choosers fits. An entry must
  /// satisfy all rules that name it or a section that contains it.
  struct EntryRule
  {
    std::vector<std::string> entries;
    std::vector<Chooser> choosers;
  };

  /// Returns the names in the entry @p constants that none of its formulas uses.
  std::vector<std::string>
  unused_constants(const Declarations &declarations, const EntryInfo &constants);

  /// Rules of all these entries; an entry without a rule always has an effect.
  std::vector<EntryRule>
  entry_rules(const Declarations &declarations);

  /// Returns the rule by which this entry has no effect, given which choosers @p fits accepts; null if it has one.
  const EntryRule *
  rule_against(const std::vector<EntryRule> &rules,
               const std::string &path,
               const std::function<bool(const Chooser &)> &fits);
} // namespace crawler
