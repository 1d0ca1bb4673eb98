// SPDX-License-Identifier: LGPL-2.1-or-later
//
// The entries without deal.II: what ParameterHandler does with them in source/parameters/entry_store.cc.
#include <crawler/parameters/entry_store.h>

#include <map>
#include <ostream>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    struct Entry
    {
      std::string value;
      std::function<bool(const std::string &)> match;
      std::function<void(const std::string &)> assign;
    };
  } // namespace

  struct EntryStore::Implementation
  {
    std::map<Path, Entry> entries;
  };

  EntryStore::EntryStore()
    : implementation_(std::make_unique<Implementation>())
  {
  }

  EntryStore::~EntryStore() = default;

  void
  EntryStore::declare(const Path &path,
                      const EntryInfo &info,
                      const std::function<bool(const std::string &)> &match,
                      const std::function<void(const std::string &)> &assign)
  {
    if (!match(info.default_value))
      throw std::logic_error("the default of \"" + info.path + "\" is not admissible");
    implementation_->entries[path] = {info.default_value, match, assign};
    assign(info.default_value);
  }

  bool
  EntryStore::set(const Path &path, const std::string &text)
  {
    Entry &entry = implementation_->entries.at(path);
    if (!entry.match(text))
      return false;
    entry.value = text;
    entry.assign(text);
    return true;
  }

  std::string
  EntryStore::get(const Path &path) const
  {
    return implementation_->entries.at(path).value;
  }

  /// Without comments.
  void
  EntryStore::print_prm(std::ostream &out) const
  {
    for (const auto &[path, entry] : implementation_->entries)
    {
      for (std::size_t i = 0; i < path.size(); ++i)
        out << (i > 0 ? "/" : "") << path[i];
      out << " = " << entry.value << "\n";
    }
  }

  void
  EntryStore::print_xml(std::ostream &) const
  {
    throw std::logic_error("the page does not write XML");
  }
} // namespace crawler
