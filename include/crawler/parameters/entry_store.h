// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/entry_info.h>

#include <cstddef>
#include <functional>
#include <iosfwd>
#include <map>
#include <string>
#include <vector>

namespace crawler
{
  /// A declared entry and its text.
  struct StoredEntry
  {
    std::vector<std::string> path; ///< the words of sections and entry
    EntryInfo info;
    std::string explanation; ///< what a user reads about it
    std::string value;
  };

  /// Keeps the texts of declared entries. A path is the words of sections and entry.
  class EntryStore
  {
  public:
    using Path = std::vector<std::string>;

    /// An entry with its default value. @p match says whether a text is admissible; @p assign sees each value from now
    /// on, the default first.
    void
    declare(const Path &path,
            const EntryInfo &info,
            const std::function<bool(const std::string &)> &match,
            const std::function<void(const std::string &)> &assign);

    /// False, and nothing changes, if @p text is not admissible.
    bool
    set(const Path &path, const std::string &text);

    std::string
    get(const Path &path) const;

    /// The present values as a .prm file with every entry explained, in the form of dealii::ParameterHandler.
    void
    print_prm(std::ostream &out) const;

  private:
    struct Actions
    {
      std::function<bool(const std::string &)> match;
      std::function<void(const std::string &)> assign;
    };

    std::vector<StoredEntry> entries_; ///< in the order in which they were declared
    std::vector<Actions> actions_;     ///< of the entries
    std::map<Path, std::size_t> places_;
  };
} // namespace crawler
