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
    std::string explanation; ///< text for the user
    std::string value;
  };

  /// Keeps the texts of declared entries. A path is the words of sections and entry.
  class EntryStore
  {
  public:
    using Path = std::vector<std::string>;

    /// Adds an entry with its default value. @p match decides whether a text is admissible; @p assign receives each
    /// value from now on, the default first.
    void
    declare(const Path &path,
            const EntryInfo &info,
            const std::function<bool(const std::string &)> &match,
            const std::function<void(const std::string &)> &assign);

    /// Sets the text of an entry; returns false and changes nothing if it is not admissible.
    bool
    set(const Path &path, const std::string &text);

    std::string
    get(const Path &path) const;

    /// Prints the present values as a .prm file with every entry explained, in the form of dealii::ParameterHandler.
    void
    print_prm(std::ostream &out) const;

  private:
    struct Actions
    {
      std::function<bool(const std::string &)> match;
      std::function<void(const std::string &)> assign;
    };

    std::vector<StoredEntry> entries_; ///< in the order of their declaration
    std::vector<Actions> actions_;     ///< of the entries
    std::map<Path, std::size_t> places_;
  };
} // namespace crawler
