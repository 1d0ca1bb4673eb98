// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/declarations.h>

#include <deal.II/base/parameter_handler.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

namespace crawler
{
  namespace
  {
    /// A pattern that says in words what it expects.
    class WordyPattern : public dealii::Patterns::PatternBase
    {
    public:
      WordyPattern(std::string expected, std::function<bool(const std::string &)> match)
        : expected_(std::move(expected))
        , match_(std::move(match))
      {
      }
      bool
      match(const std::string &text) const override
      {
        return match_(trimmed(text));
      }
      std::string
      description(const OutputStyle) const override
      {
        return expected_;
      }
      std::unique_ptr<PatternBase>
      clone() const override
      {
        return std::make_unique<WordyPattern>(*this);
      }

    private:
      std::string expected_;
      std::function<bool(const std::string &)> match_;
    };

    const std::string automatic = "automatic";

    std::optional<unsigned int>
    to_count(const std::string &text)
    {
      if (text.empty() || text.size() > 9 ||
          !std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c); }))
        return std::nullopt;
      return static_cast<unsigned int>(std::stoul(text));
    }

    std::vector<std::optional<double>>
    to_numbers(const std::string &text)
    {
      std::vector<std::optional<double>> values;
      std::istringstream in(text + ",");
      std::string item;
      while (std::getline(in, item, ','))
        values.push_back(to_number(trimmed(item)));
      return values;
    }

    /// What is perhaps wrong with a number: "0,4" or "10 cm".
    std::string
    number_hint(const std::string &text)
    {
      if (const auto comma = text.find(','); comma != std::string::npos)
        if (const std::string other = std::string(text).replace(comma, 1, "."); to_number(other))
          return fmt::format("; decimals are written with a point: {}", other);
      const std::string first = text.substr(0, text.find_first_not_of("0123456789.+-"));
      const std::string unit  = trimmed(text.substr(first.size()));
      if (first.size() < text.size() && to_number(first) && std::isalpha(static_cast<unsigned char>(unit[0])))
        return fmt::format("; a number stands alone, without its unit: {}", first);
      return "";
    }

    /// The shorter name of a file in the current folder or below it.
    std::string
    seen_from_here(const std::string &file)
    {
      const auto near = std::filesystem::path(file).lexically_relative(std::filesystem::current_path());
      return near.empty() || *near.begin() == ".." ? file : near.string();
    }

    std::string
    count_range(const unsigned int lower, const unsigned int upper)
    {
      return fmt::format("a whole number from {} to {}", lower, upper);
    }
  } // namespace


  bool
  Range::contains(const double value) const
  {
    return std::isfinite(value) && (value > lower || (lower_included && value == lower)) &&
           (value < upper || (upper_included && value == upper));
  }

  std::string
  Range::in_words() const
  {
    const bool has_lower = std::isfinite(lower), has_upper = std::isfinite(upper);
    if (!has_lower && !has_upper)
      return "a number";
    if (has_lower && !has_upper)
      return lower == 0 ? (lower_included ? "a number that is not negative" : "a positive number")
                        : fmt::format("a number {} {}", lower_included ? "from" : "above", lower);
    return fmt::format(
      "a number {} {} {} {}", lower_included ? "from" : "above", lower, upper_included ? "to" : "and below", upper);
  }

  Range
  any_number()
  {
    return {};
  }

  Range
  positive()
  {
    Range range;
    range.lower = 0;
    return range;
  }

  Range
  between(const double lower, const double upper)
  {
    return {lower, upper, true, true};
  }


  Declarations::Declarations()
    : handler_(std::make_unique<dealii::ParameterHandler>())
  {
  }

  Declarations::~Declarations() = default;

  void
  Declarations::enter(const std::string &section)
  {
    handler_->enter_subsection(section);
    section_.push_back(section);
    sections_.push_back(fmt::format("{}", fmt::join(section_, "/")));
  }

  void
  Declarations::leave()
  {
    handler_->leave_subsection();
    section_.pop_back();
  }

  std::string
  Declarations::path_of(const std::string &name) const
  {
    std::vector<std::string> words = section_;
    words.push_back(name);
    return fmt::format("{}", fmt::join(words, "/"));
  }

  void
  Declarations::declare(const std::string &name,
                        const std::string &default_value,
                        const std::string &expected,
                        const std::function<bool(const std::string &)> &match,
                        const std::function<void(const std::string &)> &assign,
                        const std::string &documentation,
                        const std::string &unit)
  {
    const std::string unit_text = unit.empty() ? "" : " Unit: " + unit + ".";
    handler_->declare_entry(
      name, default_value, WordyPattern(expected, match), documentation + " Expected: " + expected + "." + unit_text);
    handler_->add_action(name, [assign](const std::string &text) { assign(trimmed(text)); });
    entries_.push_back({path_of(name), default_value, expected, unit, documentation});
  }

  void
  Declarations::number(const std::string &name,
                       double &value,
                       const Range &range,
                       const std::string &documentation,
                       const std::string &unit)
  {
    declare(
      name,
      to_text(value),
      range.in_words(),
      [range](const std::string &text) {
        const auto number = to_number(text);
        return number && range.contains(*number);
      },
      [&value](const std::string &text) { value = *to_number(text); },
      documentation,
      unit);
  }

  void
  Declarations::number(const std::string &name,
                       std::optional<double> &value,
                       const Range &range,
                       const std::string &documentation,
                       const std::string &unit)
  {
    declare(
      name,
      value ? to_text(*value) : automatic,
      range.in_words() + " or the word \"automatic\"",
      [range](const std::string &text) {
        const auto number = to_number(text);
        return text == automatic || (number && range.contains(*number));
      },
      [&value](const std::string &text) { value = to_number(text); },
      documentation,
      unit);
  }

  void
  Declarations::whole_number(const std::string &name,
                             unsigned int &value,
                             const unsigned int lower,
                             const unsigned int upper,
                             const std::string &documentation)
  {
    declare(
      name,
      std::to_string(value),
      count_range(lower, upper),
      [lower, upper](const std::string &text) {
        const auto count = to_count(text);
        return count && *count >= lower && *count <= upper;
      },
      [&value](const std::string &text) { value = *to_count(text); },
      documentation,
      "");
  }

  void
  Declarations::whole_number(const std::string &name,
                             std::optional<unsigned int> &value,
                             const unsigned int lower,
                             const unsigned int upper,
                             const std::string &documentation)
  {
    declare(
      name,
      value ? std::to_string(*value) : automatic,
      count_range(lower, upper) + " or the word \"automatic\"",
      [lower, upper](const std::string &text) {
        const auto count = to_count(text);
        return text == automatic || (count && *count >= lower && *count <= upper);
      },
      [&value](const std::string &text) { value = to_count(text); },
      documentation,
      "");
  }

  void
  Declarations::numbers(const std::string &name,
                        std::vector<double> &value,
                        const std::string &documentation,
                        const std::string &unit)
  {
    const bool may_be_empty = value.empty();
    std::vector<std::string> items;
    for (const double number : value)
      items.push_back(to_text(number));
    declare(
      name,
      fmt::format("{}", fmt::join(items, ", ")),
      may_be_empty ? "a list of numbers separated by commas, or nothing" : "a list of numbers separated by commas",
      [may_be_empty](const std::string &text) {
        const auto all = to_numbers(text);
        return (may_be_empty && text.empty()) ||
               std::all_of(all.begin(), all.end(), [](const auto &number) { return number; });
      },
      [&value](const std::string &text) {
        value.clear();
        if (!text.empty())
          for (const auto &number : to_numbers(text))
            value.push_back(*number);
      },
      documentation,
      unit);
  }

  void
  Declarations::choice(const std::string &name,
                       std::string &value,
                       const std::vector<std::string> &words,
                       const std::string &documentation)
  {
    declare(
      name,
      value,
      words.size() == 1 ? "the word " + quoted_list(words) : quoted_list(words),
      [words](const std::string &text) { return std::find(words.begin(), words.end(), text) != words.end(); },
      [&value](const std::string &text) { value = text; },
      documentation,
      "");
  }

  void
  Declarations::flag(const std::string &name, bool &value, const std::string &documentation)
  {
    declare(
      name,
      value ? "true" : "false",
      "\"true\" or \"false\"",
      [](const std::string &text) { return text == "true" || text == "false"; },
      [&value](const std::string &text) { value = (text == "true"); },
      documentation,
      "");
  }

  void
  Declarations::text(const std::string &name,
                     std::string &value,
                     const std::string &expected,
                     const std::string &documentation,
                     const std::string &unit)
  {
    declare(
      name,
      value,
      expected,
      [](const std::string &) { return true; },
      [&value](const std::string &text) { value = text; },
      documentation,
      unit);
  }

  void
  Declarations::file(const std::string &name,
                     std::string &value,
                     const std::string &expected,
                     const std::string &documentation,
                     const std::string &unit,
                     const std::string &ending)
  {
    declare(
      name,
      value,
      expected,
      [](const std::string &) { return true; },
      [&value, ending](const std::string &text) { value = text.ends_with(ending) ? seen_from_here(text) : text; },
      documentation + " A file counts from the folder of this parameter file (with --set, from the current one).",
      unit);
    entries_.back().names_file  = true;
    entries_.back().file_ending = ending;
  }

  void
  Declarations::set(const std::string &path, const std::string &value, const std::filesystem::path &folder)
  {
    const std::vector<std::string> words = split_path(path);
    const std::string full               = fmt::format("{}", fmt::join(words, "/"));
    const auto entry =
      std::find_if(entries_.begin(), entries_.end(), [&](const EntryInfo &e) { return e.path == full; });
    if (entry == entries_.end())
    {
      const std::string section = fmt::format("{}", fmt::join(words.begin(), words.end() - 1, "/"));
      if (!section.empty())
        require_section(section);
      // Prefer names of the same section, then any entry of the same name elsewhere.
      std::vector<std::string> same_section, elsewhere;
      for (const EntryInfo &e : entries_)
      {
        const auto other                = split_path(e.path);
        const std::string other_section = fmt::format("{}", fmt::join(other.begin(), other.end() - 1, "/"));
        if (other_section == section)
          same_section.push_back(other.back());
        else if (!nearest_names(words.back(), {other.back()}).empty())
          elsewhere.push_back(e.path);
      }
      if (std::find(sections_.begin(), sections_.end(), full) != sections_.end())
        throw InputError(fmt::format("\"{}\" is a section; the name of an entry in it is expected", full), full);
      std::vector<std::string> near = nearest_names(words.back(), same_section);
      if (near.empty())
        near.assign(elsewhere.begin(), elsewhere.begin() + std::min<std::size_t>(3, elsewhere.size()));
      const std::string where = section.empty() ? "at the top level of the file" : "in section \"" + section + "\"";
      throw InputError(
        fmt::format("unknown entry \"{}\" {}; {}",
                    words.back(),
                    where,
                    near.empty()
                      ? "entries there are " + quoted_list(same_section)
                      : "the nearest " + std::string(near.size() > 1 ? "names are " : "name is ") + quoted_list(near)),
        full);
    }
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
      handler_->enter_subsection(words[i]);
    std::string problem;
    try
    {
      std::string text = trimmed(value);
      if (entry->names_file && !text.empty() && text.ends_with(entry->file_ending))
        text = std::filesystem::absolute(folder / text).lexically_normal().string();
      handler_->set(words.back(), text);
    }
    catch (const dealii::ParameterHandler::ExcValueDoesNotMatchPattern &)
    {
      problem = fmt::format("\"{}\" is \"{}\", but {} is expected", full, value, entry->expected);
      if (entry->expected.find("number") != std::string::npos)
        problem += number_hint(trimmed(value));
      // A choice of words: name the nearest one.
      if (!value.empty() && entry->expected.front() == '"')
      {
        std::vector<std::string> choices;
        for (std::size_t start = entry->expected.find('"'); start != std::string::npos;)
        {
          const std::size_t end = entry->expected.find('"', start + 1);
          choices.push_back(entry->expected.substr(start + 1, end - start - 1));
          start = entry->expected.find('"', end + 1);
        }
        const auto near = nearest_names(value, choices, 1);
        if (!near.empty())
          problem += "; the nearest is " + quoted_list(near);
      }
    }
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
      handler_->leave_subsection();
    if (!problem.empty())
      throw InputError(problem, full);
  }

  void
  Declarations::require_section(const std::string &path) const
  {
    if (std::find(sections_.begin(), sections_.end(), path) != sections_.end())
      return;
    auto near = nearest_names(path, sections_);
    if (near.empty())
      near = sections_;
    throw InputError(fmt::format("unknown section \"{}\"; the nearest {} {}",
                                 path,
                                 near.size() > 1 ? "names are" : "name is",
                                 quoted_list(near)),
                     path);
  }

  std::string
  Declarations::value(const unsigned int index) const
  {
    const std::vector<std::string> words = split_path(entries_[index].path);
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
      handler_->enter_subsection(words[i]);
    std::string result = handler_->get(words.back());
    for (std::size_t i = 0; i + 1 < words.size(); ++i)
      handler_->leave_subsection();
    return result;
  }

  void
  Declarations::print_prm(std::ostream &out) const
  {
    handler_->print_parameters(out, dealii::ParameterHandler::PRM | dealii::ParameterHandler::KeepDeclarationOrder);
  }

  void
  Declarations::print_json(std::ostream &out) const
  {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (const EntryInfo &entry : entries_)
      list.push_back({{"entry", entry.path},
                      {"default", entry.default_value},
                      {"expected", entry.expected},
                      {"unit", entry.unit},
                      {"documentation", entry.documentation}});
    out << list.dump(2) << '\n';
  }

  void
  Declarations::print_markdown(std::ostream &out) const
  {
    out << "# Parameters\n\nGenerated by `crawler parameters --format markdown`; do not edit. An entry "
           "`Section/Entry` is written\nin the file as `set Entry = value` within `subsection Section` ... "
           "`end`, and on the command line as\n`--set \"Section/Entry=value\"`.\n";
    std::string section = "-";
    for (const EntryInfo &entry : entries_)
    {
      const auto words      = split_path(entry.path);
      const std::string own = fmt::format("{}", fmt::join(words.begin(), words.end() - 1, "/"));
      if (own != section)
      {
        section = own;
        out << "\n## " << (section.empty() ? "Top level" : section)
            << "\n\n| entry | default | expected | unit | meaning |\n|---|---|---|---|---|\n";
      }
      const auto cell = [](std::string text) {
        for (std::size_t i = text.find('|'); i != std::string::npos; i = text.find('|', i + 2))
          text.replace(i, 1, "\\|");
        return text;
      };
      out << fmt::format("| {} | `{}` | {} | {} | {} |\n",
                         words.back(),
                         entry.default_value.empty() ? " " : cell(entry.default_value),
                         cell(entry.expected),
                         entry.unit,
                         cell(entry.documentation));
    }
  }


  std::string
  trimmed(const std::string &text)
  {
    const auto first = text.find_first_not_of(" \t\r\n");
    if (first == std::string::npos)
      return "";
    return text.substr(first, text.find_last_not_of(" \t\r\n") - first + 1);
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
    return fmt::format("{}", fmt::join(split_path(path), "/"));
  }

  std::optional<double>
  to_number(const std::string &text)
  {
    if (text.empty() || text.find_first_not_of("0123456789.+-eE") != std::string::npos)
      return std::nullopt;
    char *end          = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    if (end != text.c_str() + text.size() || !std::isfinite(value))
      return std::nullopt;
    return value;
  }

  std::string
  to_text(const double value)
  {
    return fmt::format("{}", value);
  }
} // namespace crawler
