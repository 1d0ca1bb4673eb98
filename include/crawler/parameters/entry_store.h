// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/entry_info.h>

#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace crawler
{
  /// Keeps the texts of declared entries, by dealii::ParameterHandler. A path is the words of sections and entry.
  class EntryStore
  {
  public:
    using Path = std::vector<std::string>;

    EntryStore();
    ~EntryStore();

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

    /// The present values as a .prm file with every entry explained.
    void
    print_prm(std::ostream &out) const;
    /// The same in the XML of dealii::ParameterHandler.
    void
    print_xml(std::ostream &out) const;

  private:
    struct Implementation;
    std::unique_ptr<Implementation> implementation_;
  };
} // namespace crawler
