// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <cstddef>
#include <optional>
#include <ostream>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace crawler
{
  /// Words for the values of an enum in files and outputs. Specialised beside the enum as an array of them in the order
  /// of its values, which count from 0.
  template <typename Enum>
  inline constexpr const char *const *words_of = nullptr;

  template <typename Enum>
  concept HasWords = std::is_array_v<decltype(words_of<Enum>)>;

  template <HasWords Enum>
  constexpr const char *
  word_of(const Enum value)
  {
    return words_of<Enum>[static_cast<std::size_t>(value)];
  }

  template <HasWords Enum>
  std::vector<std::string>
  all_words()
  {
    return {std::begin(words_of<Enum>), std::end(words_of<Enum>)};
  }

  /// Returns the value of a word; nothing if it is none of the words.
  template <HasWords Enum>
  std::optional<Enum>
  from_word(const std::string_view word)
  {
    for (std::size_t i = 0; i < std::size(words_of<Enum>); ++i)
      if (word == words_of<Enum>[i])
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
