// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/listed_numbers.h>
#include <crawler/parameters/slips.h>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

namespace crawler
{
  namespace
  {
    const std::string automatic = "automatic";

    std::optional<unsigned int>
    to_count(const std::string &text)
    {
      if (text.empty() || text.size() > 9 ||
          !std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); }))
        return std::nullopt;
      return static_cast<unsigned int>(std::stoul(text));
    }

    /// Hint at the probable error in a number like "10 cm".
    std::string
    number_hint(const std::string &text)
    {
      if (to_number(text)) // a number out of range
        return "";
      if (!probable_slip(text).empty()) // reported with the place of the entry
        return "";
      char *end = nullptr;
      std::strtod(text.c_str(), &end);
      const bool is_decimal   = text.find_first_of("xX") == std::string::npos;
      const std::string first = text.substr(0, static_cast<std::size_t>(end - text.c_str()));
      const std::string rest  = trimmed(text.substr(first.size()));
      if (is_decimal && !rest.empty() && to_number(first))
        return fmt::format("; a number must be alone, without {}: {}",
                           std::isalpha(static_cast<unsigned char>(rest[0])) ? "its unit" : "what follows it",
                           first);
      return "";
    }

    /// File name relative to the current folder if it is in or below it.
    std::string
    seen_from_here(const std::string &file)
    {
      const auto near = std::filesystem::path(file).lexically_relative(std::filesystem::current_path());
      return near.empty() || *near.begin() == ".." ? file : near.string();
    }

    /// Applies @p changed to each name of a list with semicolons.
    std::string
    each_name(const std::string &list, const std::function<std::string(const std::string &)> &changed)
    {
      std::string result;
      std::istringstream in(list);
      for (std::string name; std::getline(in, name, ';');)
        result += (result.empty() ? "" : "; ") + (trimmed(name).empty() ? "" : changed(trimmed(name)));
      return result;
    }

    std::string
    path_text(const std::vector<std::string> &words)
    {
      return fmt::format("{}", fmt::join(words, "/"));
    }

    template <typename Value>
    constexpr bool may_be_automatic = false;
    template <typename Value>
    constexpr bool may_be_automatic<std::optional<Value>> = true;

    /// A default value as text.
    template <typename Value>
    std::string
    default_text(const Value &value)
    {
      if constexpr (may_be_automatic<Value>)
        return value ? default_text(*value) : automatic;
      else if constexpr (std::is_same_v<Value, std::vector<double>>)
        return fmt::format("{}", fmt::join(value, ", "));
      else
        return fmt::format("{}", value);
    }
  } // namespace

  Declarations::Declarations(std::string only)
    : only_(std::move(only))
  {
  }

  void
  Declarations::enter(const std::string &section)
  {
    section_.push_back(section);
    sections_.push_back(path_text(section_));
  }

  void
  Declarations::leave()
  {
    section_.pop_back();
  }

  std::string
  Declarations::path_of(const std::string &name) const
  {
    std::vector<std::string> words = section_;
    words.push_back(name);
    return path_text(words);
  }

  void
  Declarations::Entry::means(const std::string &documentation)
  {
    const std::string &only = owner_.only_;
    if (!only.empty() && info_.path != only && !info_.path.starts_with(only + "/"))
      return;
    info_.documentation = documentation;
    if (info_.names_file)
      info_.documentation +=
        " A file name is relative to the folder of this parameter file (with --set, to the current one).";
    if (!take_(info_.default_value))
      throw std::logic_error("the default of \"" + info_.path + "\" is not admissible");
    if (!owner_.numbers_.emplace(info_.path, owner_.entries_.size()).second)
      throw std::logic_error("\"" + info_.path + "\" is declared twice");
    owner_.entries_.push_back(info_);
    owner_.values_.push_back(info_.default_value);
    owner_.takes_.push_back(take_);
  }

  template <typename Value, typename Read>
  Declarations::Entry
  Declarations::entry(const std::string &name,
                      Value &value,
                      const std::string &expected,
                      const std::string &unit,
                      EntryValues values,
                      const Read &read)
  {
    constexpr bool is_optional = may_be_automatic<Value>;
    values.may_be_automatic    = is_optional;
    return {*this,
            {.path          = path_of(name),
             .default_value = default_text(value),
             .expected      = is_optional ? expected + " or the word \"automatic\"" : expected,
             .unit          = unit,
             .values        = std::move(values)},
            [&value, read](const std::string &text) {
              const auto taken      = read(text);
              const bool admissible = taken || (is_optional && text == automatic);
              if (!admissible)
                return false;
              if constexpr (is_optional)
                value = taken;
              else
                value = *taken;
              return true;
            }};
  }

  template <typename Value>
  Declarations::Entry
  Declarations::number(const std::string &name, Value &value, const Range &range, const std::string &unit)
  {
    return entry(name, value, range.in_words(), unit, {EntryKind::number, range}, [range](const std::string &text) {
      const auto number = to_number(text);
      return number && range.contains(*number) ? number : std::nullopt;
    });
  }
  template Declarations::Entry
  Declarations::number(const std::string &, double &, const Range &, const std::string &);
  template Declarations::Entry
  Declarations::number(const std::string &, std::optional<double> &, const Range &, const std::string &);

  template <typename Value>
  Declarations::Entry
  Declarations::whole_number(const std::string &name, Value &value, const unsigned int lower, const unsigned int upper)
  {
    return entry(name,
                 value,
                 fmt::format("a whole number from {} to {}", lower, upper),
                 "",
                 {EntryKind::whole_number, between(lower, upper)},
                 [lower, upper](const std::string &text) {
                   const auto count = to_count(text);
                   return count && *count >= lower && *count <= upper ? count : std::nullopt;
                 });
  }
  template Declarations::Entry
  Declarations::whole_number(const std::string &, unsigned int &, unsigned int, unsigned int);
  template Declarations::Entry
  Declarations::whole_number(const std::string &, std::optional<unsigned int> &, unsigned int, unsigned int);

  Declarations::Entry
  Declarations::numbers(const std::string &name,
                        std::vector<double> &value,
                        const std::string &unit,
                        const bool one_is_all)
  {
    const bool may_be_empty    = value.empty();
    const std::string expected = "a list of numbers separated by commas";
    return entry(name,
                 value,
                 may_be_empty ? expected + ", or nothing" : expected,
                 unit,
                 {.kind = EntryKind::numbers, .may_be_empty = may_be_empty, .one_is_all = one_is_all},
                 [may_be_empty](const std::string &text) {
                   return may_be_empty && text.empty() ? std::optional(std::vector<double>()) : to_numbers(text);
                 });
  }

  Declarations::Entry
  Declarations::choice(const std::string &name,
                       const std::string &default_word,
                       const std::vector<std::string> &words,
                       const std::function<void(const std::string &)> &assign)
  {
    return {*this,
            {.path          = path_of(name),
             .default_value = default_word,
             .expected      = words.size() == 1 ? "the word " + quoted_list(words) : quoted_list(words),
             .values        = {.kind = EntryKind::choice, .words = words}},
            [words, assign](const std::string &text) {
              if (std::find(words.begin(), words.end(), text) == words.end())
                return false;
              assign(text);
              return true;
            }};
  }

  Declarations::Entry
  Declarations::choice(const std::string &name, std::string &value, const std::vector<std::string> &words)
  {
    return choice(name, value, words, [&value](const std::string &word) { value = word; });
  }

  Declarations::Entry
  Declarations::flag(const std::string &name, bool &value)
  {
    return entry(name,
                 value,
                 "\"true\" or \"false\"",
                 "",
                 {.kind = EntryKind::flag, .words = {"true", "false"}},
                 [](const std::string &text) {
                   return text == "true" || text == "false" ? std::optional(text == "true") : std::nullopt;
                 });
  }

  Declarations::Entry
  Declarations::text(const std::string &name, std::string &value, const std::string &expected, const std::string &unit)
  {
    return entry(name, value, expected, unit, {}, [](const std::string &text) { return std::optional(text); });
  }

  Declarations::Entry
  Declarations::constants(const std::string &name, std::string &value, const std::vector<std::string> &formulas)
  {
    Entry result             = text(name, value, "a list name=number, name=number");
    result.info_.values.kind = EntryKind::constants;
    for (const std::string &formula : formulas)
      result.info_.values.words.push_back(path_of(formula));
    return result;
  }

  Declarations::Entry
  Declarations::profile(const std::string &name, std::string &value)
  {
    Entry result =
      file(name,
           value,
           "a formula of s, a list of numbers, or a CSV file (a name that ends in .csv) with the header s,value",
           "1",
           ".csv");
    result.info_.values.kind = EntryKind::profile;
    return result;
  }

  Declarations::Entry
  Declarations::file(const std::string &name,
                     std::string &value,
                     const std::string &expected,
                     const std::string &unit,
                     const std::string &ending)
  {
    Entry result             = entry(name, value, expected, unit, {}, [ending](const std::string &text) {
      return std::optional(text.ends_with(ending) ? seen_from_here(text) : text);
    });
    result.info_.names_file  = true;
    result.info_.file_ending = ending;
    return result;
  }

  Declarations::Entry
  Declarations::files(const std::string &name, std::string &value, const std::string &expected)
  {
    Entry result            = entry(name, value, expected, "", {}, [](const std::string &text) {
      return std::optional(each_name(text, seen_from_here));
    });
    result.info_.names_file = result.info_.names_several = true;
    return result;
  }

  void
  Declarations::set(const std::string &path, const std::string &value, const std::filesystem::path &folder)
  {
    std::vector<std::string> words = split_path(path);
    const auto key                 = take_key(words.back());
    const unsigned int index       = find(words);
    const EntryInfo &entry         = entries_[index];
    if (key)
    {
      const auto number = to_number(trimmed(value));
      if (!number)
        refuse(entry.path,
               "\"{}[{}]\" is \"{}\", but a number is expected{}",
               entry.path,
               *key,
               value,
               number_hint(trimmed(value)));
      set(entry.path, with_listed_number(entry, values_[index], *key, *number));
      return;
    }
    const std::string text = with_absolute_name(path, value, folder);
    if (takes_[index](text))
    {
      values_[index] = text;
      return;
    }
    const bool is_number = entry.expected.find("number") != std::string::npos;
    refuse(entry.path,
           "\"{}\" is \"{}\", but {} is expected{}{}",
           entry.path,
           value,
           entry.expected,
           is_number ? number_hint(trimmed(value)) : "",
           value.empty() ? "" : nearest_hint(value, entry.values.words));
  }

  std::string
  Declarations::with_absolute_name(const std::string &path,
                                   const std::string &value,
                                   const std::filesystem::path &folder) const
  {
    const EntryInfo &entry = info(path);
    std::string text       = trimmed(value);
    if (!entry.names_file || text.empty() || !text.ends_with(entry.file_ending))
      return text;
    if (const std::string sign = home_sign(text); !sign.empty())
      refuse_entry(entry.path, "{}", sign);
    const auto absolute = [&](const std::string &name) {
      return std::filesystem::absolute(folder / name).lexically_normal().string();
    };
    return entry.names_several ? each_name(text, absolute) : absolute(text);
  }

  const EntryInfo &
  Declarations::info(const std::string &path) const
  {
    std::vector<std::string> words = split_path(path);
    take_key(words.back());
    return entries_[find(words)];
  }

  std::string
  Declarations::value(const std::string &path) const
  {
    std::vector<std::string> words = split_path(path);
    const auto key                 = take_key(words.back());
    const unsigned int index       = find(words);
    return key ? to_text(listed_number(entries_[index], values_[index], *key)) : values_[index];
  }

  unsigned int
  Declarations::find(const std::vector<std::string> &path) const
  {
    const auto found = numbers_.find(path_text(path));
    if (found != numbers_.end())
      return found->second;
    refuse_name(path);
  }

  /// Reports the nearest names: those of the same section, else any entry of a near name elsewhere.
  void
  Declarations::refuse_name(const std::vector<std::string> &words) const
  {
    const std::string full = path_text(words), section = section_of(full);
    if (!section.empty())
      require_section(section);
    const std::string top = "at the top level of the file";
    std::vector<std::string> same_section, elsewhere;
    for (const EntryInfo &e : entries_)
    {
      const std::string name = split_path(e.path).back();
      if (section_of(e.path) == section)
        same_section.push_back(name);
      else if (!nearest_names(words.back(), {name}).empty())
        elsewhere.push_back(e.path);
    }
    if (std::find(sections_.begin(), sections_.end(), full) != sections_.end())
      refuse(full, "\"{}\" is a section; the name of an entry in it is expected", full);
    std::vector<std::string> near = nearest_names(words.back(), same_section);
    if (near.empty())
      near.assign(elsewhere.begin(), elsewhere.begin() + std::min<std::size_t>(3, elsewhere.size()));
    const bool is_of_top =
      std::any_of(elsewhere.begin(), elsewhere.end(), [&](const std::string &path) { return path == words.back(); });
    refuse(full,
           "unknown entry \"{}\" {}; {}",
           words.back(),
           section.empty() ? top : "in section \"" + section + "\"",
           is_of_top          ? "it is expected " + top
           : near.empty()     ? "entries there are " + quoted_list(same_section)
           : near.size() == 1 ? "the nearest name is " + quoted_list(near)
                              : "the nearest names are " + quoted_list(near));
  }

  void
  Declarations::require_section(const std::string &path) const
  {
    if (std::find(sections_.begin(), sections_.end(), path) != sections_.end())
      return;
    if (const std::string now = successor_of(path); !now.empty())
      refuse(path, "the section \"{}\" was removed; {} is expected", path, now);
    const auto near = nearest_names(path, sections_);
    if (near.empty())
    {
      std::vector<std::string> outer;
      std::ranges::copy_if(
        sections_, std::back_inserter(outer), [](const std::string &s) { return s.find('/') == std::string::npos; });
      refuse(path, "unknown section \"{}\"; {} is expected", path, quoted_list(outer));
    }
    refuse(path,
           "unknown section \"{}\"; the nearest {} {}",
           path,
           near.size() > 1 ? "names are" : "name is",
           quoted_list(near));
  }

  std::vector<std::string>
  split_path(const std::string &path)
  {
    std::vector<std::string> words;
    std::istringstream in(path);
    std::string word;
    while (std::getline(in, word, '/'))
      words.push_back(trimmed(word));
    if (words.empty())
      words.emplace_back();
    return words;
  }

  std::string
  section_of(const std::string &path)
  {
    const std::size_t slash = path.rfind('/');
    return slash == std::string::npos ? "" : path.substr(0, slash);
  }

  std::string
  normal_path(const std::string &path)
  {
    return path_text(split_path(path));
  }
} // namespace crawler
