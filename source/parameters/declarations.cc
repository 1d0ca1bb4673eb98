// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>
#include <crawler/parameters/entry_store.h>
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

    /// Path of the section of an entry.
    std::string
    section_of(const std::vector<std::string> &words)
    {
      return fmt::format("{}", fmt::join(words.begin(), words.end() - 1, "/"));
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

    // Readers of values: nothing if a text is not admissible.

    auto
    reader(const Range &range)
    {
      return [range](const std::string &text) {
        const auto number = to_number(text);
        return number && range.contains(*number) ? number : std::nullopt;
      };
    }
    auto
    reader(const unsigned int lower, const unsigned int upper)
    {
      return [lower, upper](const std::string &text) {
        const auto count = to_count(text);
        return count && *count >= lower && *count <= upper ? count : std::nullopt;
      };
    }

    std::string
    count_range(const unsigned int lower, const unsigned int upper)
    {
      return fmt::format("a whole number from {} to {}", lower, upper);
    }

    /// Hint naming the nearest word of a choice.
    std::string
    nearest_word(const std::string &value, const std::vector<std::string> &words)
    {
      if (value.empty())
        return "";
      const auto near = nearest_names(value, words, 1);
      return near.empty() ? "" : "; the nearest is " + quoted_list(near);
    }
  } // namespace


  Declarations::Declarations(std::string only)
    : only_(std::move(only))
    , store_(std::make_unique<EntryStore>())
  {
  }

  Declarations::~Declarations() = default;

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
    const auto of_trimmed = [](const auto &function) {
      return [function](const std::string &text) { return function(trimmed(text)); };
    };
    owner_.store_->declare(split_path(info_.path), info_, of_trimmed(match_), of_trimmed(assign_));
    owner_.entries_.push_back(info_);
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
    Entry result(
      *this,
      name,
      {path_of(name), default_text(value), is_optional ? expected + " or the word \"automatic\"" : expected, unit, ""});
    values.may_be_automatic = is_optional;
    result.info_.values     = std::move(values);
    result.match_           = [read](const std::string &text) {
      return (is_optional && text == automatic) || read(text).has_value();
    };
    result.assign_ = [&value, read](const std::string &text) {
      if constexpr (is_optional)
        value = read(text);
      else
        value = *read(text);
    };
    return result;
  }

  Declarations::Entry
  Declarations::number(const std::string &name, double &value, const Range &range, const std::string &unit)
  {
    return entry(name, value, range.in_words(), unit, {EntryKind::number, range}, reader(range));
  }

  Declarations::Entry
  Declarations::number(const std::string &name,
                       std::optional<double> &value,
                       const Range &range,
                       const std::string &unit)
  {
    return entry(name, value, range.in_words(), unit, {EntryKind::number, range}, reader(range));
  }

  Declarations::Entry
  Declarations::whole_number(const std::string &name,
                             unsigned int &value,
                             const unsigned int lower,
                             const unsigned int upper)
  {
    return entry(name,
                 value,
                 count_range(lower, upper),
                 "",
                 {EntryKind::whole_number, between(lower, upper)},
                 reader(lower, upper));
  }

  Declarations::Entry
  Declarations::whole_number(const std::string &name,
                             std::optional<unsigned int> &value,
                             const unsigned int lower,
                             const unsigned int upper)
  {
    return entry(name,
                 value,
                 count_range(lower, upper),
                 "",
                 {EntryKind::whole_number, between(lower, upper)},
                 reader(lower, upper));
  }

  Declarations::Entry
  Declarations::numbers(const std::string &name, std::vector<double> &value, const std::string &unit)
  {
    const bool may_be_empty    = value.empty();
    const std::string expected = "a list of numbers separated by commas";
    return entry(name,
                 value,
                 may_be_empty ? expected + ", or nothing" : expected,
                 unit,
                 {.kind = EntryKind::numbers, .may_be_empty = may_be_empty},
                 [may_be_empty](const std::string &text) {
                   return may_be_empty && text.empty() ? std::optional(std::vector<double>()) : to_numbers(text);
                 });
  }

  Declarations::Entry
  Declarations::choice(const std::string &name,
                       const std::vector<std::string> &words,
                       const std::size_t value,
                       const std::function<void(std::size_t)> &assign)
  {
    const auto place = [words](const std::string &text) {
      return static_cast<std::size_t>(std::find(words.begin(), words.end(), text) - words.begin());
    };
    Entry result(*this, name, {path_of(name), words[value], quoted_list(words), "", ""});
    result.info_.values = {.kind = EntryKind::choice, .words = words};
    result.match_       = [place, n = words.size()](const std::string &text) { return place(text) < n; };
    result.assign_      = [place, assign](const std::string &text) { assign(place(text)); };
    return result;
  }

  Declarations::Entry
  Declarations::choice(const std::string &name, std::string &value, const std::vector<std::string> &words)
  {
    return entry(name,
                 value,
                 words.size() == 1 ? "the word " + quoted_list(words) : quoted_list(words),
                 "",
                 {.kind = EntryKind::choice, .words = words},
                 [words](const std::string &text) {
                   return std::find(words.begin(), words.end(), text) != words.end() ? std::optional(text)
                                                                                     : std::nullopt;
                 });
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
    const EntryInfo &entry         = find(words);
    if (key)
    {
      const auto number = to_number(trimmed(value));
      if (!number)
        throw InputError(
          fmt::format(
            "\"{}[{}]\" is \"{}\", but a number is expected{}", entry.path, *key, value, number_hint(trimmed(value))),
          entry.path);
      set(entry.path, with_listed_number(entry, this->value(entry.path), *key, *number));
      return;
    }
    const std::string text = with_absolute_name(path, value, folder);
    if (store_->set(words, text))
      return;
    const bool is_number = entry.expected.find("number") != std::string::npos;
    throw InputError(fmt::format("\"{}\" is \"{}\", but {} is expected{}{}",
                                 entry.path,
                                 value,
                                 entry.expected,
                                 is_number ? number_hint(trimmed(value)) : "",
                                 nearest_word(value, entry.values.words)),
                     entry.path);
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
      throw InputError(fmt::format("\"{}\": {}", entry.path, sign), entry.path);
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
    return find(words);
  }

  std::string
  Declarations::value(const std::string &path) const
  {
    std::vector<std::string> words = split_path(path);
    const auto key                 = take_key(words.back());
    const EntryInfo &entry         = find(words);
    const std::string text         = value(static_cast<unsigned int>(&entry - entries_.data()));
    return key ? to_text(listed_number(entry, text, *key)) : text;
  }

  const EntryInfo &
  Declarations::find(const std::vector<std::string> &path) const
  {
    const std::string full = path_text(path);
    for (const EntryInfo &entry : entries_)
      if (entry.path == full)
        return entry;
    refuse_name(path);
  }

  /// Reports the nearest names: those of the same section, else any entry of a near name elsewhere.
  void
  Declarations::refuse_name(const std::vector<std::string> &words) const
  {
    const std::string full = path_text(words), section = section_of(words);
    if (!section.empty())
      require_section(section);
    const std::string top = "at the top level of the file";
    std::vector<std::string> same_section, elsewhere;
    for (const EntryInfo &e : entries_)
    {
      const auto other = split_path(e.path);
      if (section_of(other) == section)
        same_section.push_back(other.back());
      else if (!nearest_names(words.back(), {other.back()}).empty())
        elsewhere.push_back(e.path);
    }
    if (std::find(sections_.begin(), sections_.end(), full) != sections_.end())
      throw InputError(fmt::format("\"{}\" is a section; the name of an entry in it is expected", full), full);
    std::vector<std::string> near = nearest_names(words.back(), same_section);
    if (near.empty())
      near.assign(elsewhere.begin(), elsewhere.begin() + std::min<std::size_t>(3, elsewhere.size()));
    const bool is_of_top =
      std::any_of(elsewhere.begin(), elsewhere.end(), [&](const std::string &path) { return path == words.back(); });
    throw InputError(fmt::format("unknown entry \"{}\" {}; {}",
                                 words.back(),
                                 section.empty() ? top : "in section \"" + section + "\"",
                                 is_of_top          ? "it is expected " + top
                                 : near.empty()     ? "entries there are " + quoted_list(same_section)
                                 : near.size() == 1 ? "the nearest name is " + quoted_list(near)
                                                    : "the nearest names are " + quoted_list(near)),
                     full);
  }

  void
  Declarations::require_section(const std::string &path) const
  {
    if (std::find(sections_.begin(), sections_.end(), path) != sections_.end())
      return;
    if (const std::string now = successor_of(path); !now.empty())
      throw InputError(fmt::format("the section \"{}\" was removed; {} is expected", path, now), path);
    const auto near = nearest_names(path, sections_);
    if (near.empty())
    {
      std::vector<std::string> outer;
      std::ranges::copy_if(
        sections_, std::back_inserter(outer), [](const std::string &s) { return s.find('/') == std::string::npos; });
      throw InputError(fmt::format("unknown section \"{}\"; {} is expected", path, quoted_list(outer)), path);
    }
    throw InputError(fmt::format("unknown section \"{}\"; the nearest {} {}",
                                 path,
                                 near.size() > 1 ? "names are" : "name is",
                                 quoted_list(near)),
                     path);
  }

  std::string
  Declarations::value(const unsigned int index) const
  {
    return store_->get(split_path(entries_[index].path));
  }

  void
  Declarations::print_prm(std::ostream &out) const
  {
    store_->print_prm(out);
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
  normal_path(const std::string &path)
  {
    return path_text(split_path(path));
  }
} // namespace crawler
