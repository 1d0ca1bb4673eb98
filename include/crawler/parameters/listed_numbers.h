// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/entry_info.h>

#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  /// A number of an entry that has several, "Section/Entry[key]".
  struct ListedNumber
  {
    std::string key; ///< place in a list, from 1 on, or name of a constant
    double value;
  };

  /// The numbers of an entry whose value is @p text; none for a single number that stands for all or another kind of
  /// value, including a profile that is a formula or a file.
  std::vector<ListedNumber>
  listed_numbers(const EntryInfo &entry, const std::string &text);

  /// The number that @p key names; 0 beyond the end of a list of any length. Throws InputError if there can be none.
  double
  listed_number(const EntryInfo &entry, const std::string &text, const std::string &key);

  /// The value @p text of the entry with the number @p key replaced; a list of any length is padded with zeros.
  /// Throws InputError.
  std::string
  with_listed_number(const EntryInfo &entry, const std::string &text, const std::string &key, double value);

  /// Removes the key in brackets from the end of a path and returns it; nothing if there is none.
  std::optional<std::string>
  take_key(std::string &path);
} // namespace crawler
