// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/entry_info.h>

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// One of the numbers that an entry is made of, "Section/Entry[key]".
  struct ListedNumber
  {
    std::string key; ///< its place in a list, from 1 on, or the name of a constant
    double value;
  };

  /// Those of an entry whose value is @p text; none of a single number or another kind of value, so also of a profile
  /// that is a formula or a file.
  std::vector<ListedNumber>
  listed_numbers(const EntryInfo &entry, const std::string &text);

  /// The number that @p key names; 0 behind the end of a list of any length. Throws InputError if there can be none.
  double
  listed_number(const EntryInfo &entry, const std::string &text, const std::string &key);

  /// The value @p text of the entry with another number there; a list is filled up by zeros. Throws InputError.
  std::string
  with_listed_number(const EntryInfo &entry, const std::string &text, const std::string &key, double value);

  /// What stands in brackets at the end of a path, which is taken away; nothing if nothing does.
  std::optional<std::string>
  take_key(std::string &path);
} // namespace crawler
