// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/parameters/entry_store.h>

#include <algorithm>
#include <ostream>
#include <sstream>
#include <stdexcept>

namespace crawler
{
  namespace
  {
    using Entries = std::vector<StoredEntry>;

    bool
    is_below(const StoredEntry &entry, const EntryStore::Path &section)
    {
      return entry.path.size() > section.size() && std::equal(section.begin(), section.end(), entry.path.begin());
    }

    /// Breaks @p text into lines of at most @p width characters; the last one is shorter than that, as
    /// dealii::ParameterHandler writes them.
    std::vector<std::string>
    lines_of(const std::string &text, const std::size_t width)
    {
      std::vector<std::string> lines;
      std::istringstream words(text);
      for (std::string word; words >> word;)
      {
        const bool is_last = (words >> std::ws).eof();
        if (lines.empty() || lines.back().size() + 1 + word.size() + (is_last ? 1 : 0) > width)
          lines.push_back(word);
        else
          lines.back() += " " + word;
      }
      return lines;
    }

    /// A section of a .prm file, with its entries and sections in the order of their declaration.
    class Section
    {
    public:
      Section(const Entries &entries, EntryStore::Path path)
        : path_(std::move(path))
        , indent_(2 * path_.size(), ' ')
      {
        for (const StoredEntry &entry : entries)
        {
          if (!is_below(entry, path_))
            continue;
          if (entry.path.size() == path_.size() + 1)
            own_.push_back(&entry);
          else if (const std::string &name = entry.path[path_.size()]; std::ranges::find(names_, name) == names_.end())
            names_.push_back(name);
        }
      }

      void
      print(std::ostream &out, const Entries &entries) const
      {
        print_entries(out);
        if (!own_.empty() && !names_.empty())
          out << "\n\n";
        for (const std::string &name : names_)
        {
          EntryStore::Path path = path_;
          path.push_back(name);
          out << indent_ << "subsection " << name << "\n";
          Section(entries, path).print(out, entries);
          out << indent_ << "end\n" << (path_.empty() ? "\n\n" : "\n");
        }
      }

    private:
      void
      print_entries(std::ostream &out) const
      {
        constexpr std::size_t width = 78;
        std::size_t longest_name = 0, longest_value = 0;
        for (const StoredEntry *entry : own_)
        {
          longest_name  = std::max(longest_name, entry->path.back().size());
          longest_value = std::max(longest_value, entry->value.size());
        }
        bool is_first = true;
        for (const StoredEntry *entry : own_)
        {
          if (!is_first)
            out << "\n";
          is_first = false;
          for (const std::string &line : lines_of(entry->explanation, width - indent_.size() - 2))
            out << indent_ << "# " << line << "\n";
          const std::string &name = entry->path.back();
          out << indent_ << "set " << name << std::string(longest_name - name.size(), ' ') << " = " << entry->value;
          if (entry->value != entry->info.default_value)
            out << std::string(longest_value - entry->value.size(), ' ') << " # default: " << entry->info.default_value;
          out << "\n";
        }
      }

      const EntryStore::Path path_;
      const std::string indent_;
      std::vector<const StoredEntry *> own_;
      std::vector<std::string> names_; ///< of the sections below
    };
  } // namespace

  void
  EntryStore::declare(const Path &path,
                      const EntryInfo &info,
                      const std::function<bool(const std::string &)> &match,
                      const std::function<void(const std::string &)> &assign)
  {
    if (!match(info.default_value))
      throw std::logic_error("the default of \"" + info.path + "\" is not admissible");
    if (!places_.emplace(path, entries_.size()).second)
      throw std::logic_error("\"" + info.path + "\" is declared twice");
    const std::string unit = info.unit.empty() ? "" : " Unit: " + info.unit + ".";
    entries_.push_back(
      {path, info, info.documentation + " Expected: " + info.expected + "." + unit, info.default_value});
    actions_.push_back({match, assign});
    assign(info.default_value);
  }

  bool
  EntryStore::set(const Path &path, const std::string &text)
  {
    const std::size_t i = places_.at(path);
    if (!actions_[i].match(text))
      return false;
    entries_[i].value = text;
    actions_[i].assign(text);
    return true;
  }

  std::string
  EntryStore::get(const Path &path) const
  {
    return entries_[places_.at(path)].value;
  }

  void
  EntryStore::print_prm(std::ostream &out) const
  {
    out << "# Listing of Parameters\n# ---------------------\n";
    Section(entries_, {}).print(out, entries_);
  }
} // namespace crawler
