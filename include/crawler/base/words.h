// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <vector>

namespace crawler
{
  /// Words for the values of an enum in files and outputs. Specialised beside the enum with a `static constexpr const
  /// char *list[]` in the order of its values, which count from 0.
  template <typename Enum>
  struct Words;

  template <typename Enum>
  concept HasWords = requires
  {
    Words<Enum>::list;
  };

  template <HasWords Enum>
  constexpr const char *
  word_of(const Enum value)
  {
    return Words<Enum>::list[static_cast<std::size_t>(value)];
  }

  template <HasWords Enum>
  std::vector<std::string>
  all_words()
  {
    return {std::begin(Words<Enum>::list), std::end(Words<Enum>::list)};
  }

  /// Returns the value of a word; nothing if it is none of the words.
  template <HasWords Enum>
  std::optional<Enum>
  from_word(const std::string_view word)
  {
    for (std::size_t i = 0; i < std::size(Words<Enum>::list); ++i)
      if (word == Words<Enum>::list[i])
        return static_cast<Enum>(i);
    return std::nullopt;
  }

  template <HasWords Enum>
  std::ostream &
  operator<<(std::ostream &out, const Enum value)
  {
    return out << word_of(value);
  }
} // namespace crawler
