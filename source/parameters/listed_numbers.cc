// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/exceptions.h>
#include <crawler/base/nearest_name.h>
#include <crawler/parameters/listed_numbers.h>
#include <crawler/parameters/plain_text.h>

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

namespace crawler
{
  namespace
  {
    constexpr std::size_t longest_list = 10000; ///< that a number in brackets may create

    std::vector<ListedNumber>
    in_places(const std::vector<double> &numbers)
    {
      std::vector<ListedNumber> list;
      for (const double number : numbers)
        list.push_back({std::to_string(list.size() + 1), number});
      return list;
    }

    /// Constants of a formula; none if the list has an error, which the reader of the formula reports.
    std::vector<ListedNumber>
    constants_of(const std::string &text)
    {
      std::vector<ListedNumber> list;
      std::istringstream in(text);
      for (std::string item; std::getline(in, item, ',');)
      {
        const auto equals = item.find('=');
        const auto number = to_number(equals == std::string::npos ? std::string() : trimmed(item.substr(equals + 1)));
        if (!number)
          return {};
        list.push_back({trimmed(item.substr(0, equals)), *number});
      }
      return list;
    }

    /// Throws InputError that says which keys are admissible.
    [[noreturn]] void
    refuse_key(const EntryInfo &entry,
               const std::string &text,
               const std::string &key,
               const std::vector<ListedNumber> &list)
    {
      const std::string number = fmt::format("\"{}[{}]\"", entry.path, key);
      std::vector<std::string> names, near;
      for (const ListedNumber &one : list)
        names.push_back(one.key);
      switch (entry.values.one_is_all ? EntryKind::profile : entry.values.kind)
      {
        case EntryKind::constants:
          near = nearest_names(key, names, 1);
          if (names.empty())
            refuse(entry.path,
                   "{} names a constant, but \"{}\" has none; {} is expected there",
                   number,
                   entry.path,
                   entry.expected);
          refuse(entry.path,
                 "{} names no constant: {} is expected{}",
                 number,
                 quoted_list(names),
                 near.empty() || names.size() == 1 ? "" : "; the nearest name is " + quoted_list(near));
        case EntryKind::profile:
          if (list.empty())
            refuse(entry.path,
                   "{} names a number of a list, but \"{}\" is \"{}\"; {} expected there, like 1, 1, 1, 1",
                   number,
                   entry.path,
                   text,
                   entry.values.one_is_all ? "a number for each part is"
                                           : "numbers at equally spaced places from tail to head are");
          refuse(entry.path,
                 "{0} names no number of the list; \"{1}\" has {2} of them, so [1] to [{2}] are expected",
                 number,
                 entry.path,
                 list.size());
        case EntryKind::numbers:
          refuse(entry.path,
                 "\"{}\" should name a number of a list, but a whole number from 1 to {} is expected in the brackets",
                 entry.path,
                 longest_list);
        default:
          refuse(entry.path, "{} names a number of a list, but \"{}\" is {}", number, entry.path, entry.expected);
      }
    }

    /// The numbers of the entry, and the index that the key names; a list of any length is extended to it.
    std::pair<std::vector<ListedNumber>, std::size_t>
    numbers_with(const EntryInfo &entry, const std::string &text, const std::string &key)
    {
      std::vector<ListedNumber> list = listed_numbers(entry, text);
      const auto number              = to_number(key);
      const bool may_grow            = entry.values.kind == EntryKind::numbers && !entry.values.one_is_all;
      if (may_grow && number && *number >= 1. && *number <= longest_list)
        for (std::size_t n = list.size() + 1; static_cast<double>(n) <= *number; ++n)
          list.push_back({std::to_string(n), 0.});
      const auto found = std::ranges::find(list, key, &ListedNumber::key);
      if (found != list.end())
      {
        const auto place = static_cast<std::size_t>(found - list.begin());
        return {std::move(list), place};
      }
      refuse_key(entry, text, key, list);
    }
  } // namespace

  std::vector<ListedNumber>
  listed_numbers(const EntryInfo &entry, const std::string &text)
  {
    if (entry.values.kind == EntryKind::constants)
      return constants_of(text);
    const bool may_be_one = entry.values.kind == EntryKind::profile || entry.values.one_is_all;
    const bool is_list    = may_be_one ? text.find(',') != std::string::npos : entry.values.kind == EntryKind::numbers;
    return is_list ? in_places(to_numbers(text).value_or(std::vector<double>())) : std::vector<ListedNumber>();
  }

  double
  listed_number(const EntryInfo &entry, const std::string &text, const std::string &key)
  {
    const auto [list, place] = numbers_with(entry, text, key);
    return list[place].value;
  }

  std::string
  with_listed_number(const EntryInfo &entry, const std::string &text, const std::string &key, const double value)
  {
    auto [list, place] = numbers_with(entry, text, key);
    list[place].value  = value;
    std::string result;
    for (const ListedNumber &other : list)
      result += (result.empty() ? "" : ", ") + (entry.values.kind == EntryKind::constants ? other.key + " = " : "") +
                to_text(other.value);
    return result;
  }

  std::optional<std::string>
  take_key(std::string &path)
  {
    const std::size_t start = path.find('[');
    if (start == std::string::npos || !path.ends_with(']'))
      return std::nullopt;
    std::string key = trimmed(path.substr(start + 1, path.size() - start - 2));
    path            = trimmed(path.substr(0, start));
    return key;
  }
} // namespace crawler
