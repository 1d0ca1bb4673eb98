// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/parameters.h>

#include <algorithm>
#include <string>
#include <vector>

namespace crawler
{
  /// Some entries of a section (or the beginnings of their names) that have an effect only if another one, the
  /// chooser, has one of certain values.
  struct EntryRule
  {
    std::string section;
    std::vector<std::string> entries;
    std::string chooser, value;
    std::vector<std::string> needed;

    /// Has this entry no effect?
    bool
    is_against(const std::string &path) const
    {
      return std::find(needed.begin(), needed.end(), value) == needed.end() &&
             std::any_of(entries.begin(), entries.end(), [&](const std::string &entry) {
               return path.starts_with(section + entry);
             });
    }
  };

  std::vector<EntryRule>
  entry_rules(const Parameters &parameters);
} // namespace crawler
