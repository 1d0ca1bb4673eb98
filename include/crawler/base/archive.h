// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>

#include <array>
#include <concepts>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>

namespace crawler
{
  /**
   * The exact state of objects as bytes: an archive made without bytes writes, one made with bytes reads. One function
   * lists the members of a type for both directions,
   *
   *     void exchange(Archive &archive) { archive(first_, second_); }
   *
   * The bytes are valid for the same program on the same kind of machine only. Reading what was not written throws
   * FileError; sizes are checked before memory is allocated.
   */
  class Archive
  {
  public:
    Archive() = default;
    explicit Archive(std::string bytes)
      : bytes_(std::move(bytes))
      , reads_(true)
    {
    }

    bool
    reads() const
    {
      return reads_;
    }
    /// All bytes written.
    const std::string &
    bytes() const
    {
      return bytes_;
    }

    template <typename... Types>
    void
    operator()(Types &...values)
    {
      (one(values), ...);
    }

    /// Throws FileError unless the values read make sense.
    void
    require(const bool makes_sense, const char *what) const
    {
      if (reads_ && !makes_sense)
        fail(what);
    }

    /// Checks a value that must equal the one at writing: numbers and kinds of things that are not exchanged
    /// themselves.
    template <typename Type>
    void
    require_same(Type value, const char *what)
    {
      const Type own = value;
      one(value);
      require(value == own, what);
    }

  private:
    template <typename Type>
    static constexpr bool has_exchange = requires(Type &value, Archive &archive)
    {
      value.exchange(archive);
    };
    /// True for numbers and structures of nothing but numbers, whose bytes are their value. A structure with truth
    /// values or enums must list its members (exchange), so that each is checked.
    template <typename Type>
    static constexpr bool is_raw =
      !has_exchange<Type> && !std::is_same_v<Type, bool> &&
      (std::is_arithmetic_v<Type> || (std::is_aggregate_v<Type> && std::is_trivially_copyable_v<Type>));

    template <typename Type>
    void
    one(Type &value)
    {
      if constexpr (has_exchange<Type>)
        value.exchange(*this);
      else if constexpr (std::is_enum_v<Type>)
        kind(value);
      else if constexpr (requires { value.resize(0); })
        list(value);
      else
      {
        static_assert(is_raw<Type>);
        raw(&value, sizeof(Type));
      }
    }
    template <typename Enum>
    void
    kind(Enum &value)
    {
      auto number = static_cast<unsigned int>(value);
      raw(&number, sizeof(number));
      if constexpr (HasWords<Enum>)
        require(number < std::size(words_of<Enum>), "a kind");
      value = static_cast<Enum>(number);
    }
    /// Truth values are checked: using a byte other than 0 or 1 as one is undefined.
    void
    one(bool &value)
    {
      unsigned char byte = value ? 1 : 0;
      raw(&byte, sizeof(byte));
      if (byte > 1)
        fail("a truth value");
      value = byte == 1;
    }
    template <typename Type, std::size_t n>
    void
    one(std::array<Type, n> &list)
    {
      for (Type &value : list)
        one(value);
    }
    template <typename First, typename Second>
    void
    one(std::pair<First, Second> &pair)
    {
      (*this)(pair.first, pair.second);
    }
    template <typename Type>
    void
    one(std::optional<Type> &value)
    {
      bool is_there = value.has_value();
      one(is_there);
      if (!is_there)
        value.reset();
      else if (!value)
      {
        if constexpr (std::default_initializable<Type>)
          value.emplace();
        else
          fail("a value");
      }
      if (value)
        one(*value);
    }

    template <typename List>
    void
    list(List &list)
    {
      using Type = typename List::value_type;
      resize(list, is_raw<Type> ? sizeof(Type) : 1);
      if constexpr (requires { list.data(); } && is_raw<Type>)
        raw(list.data(), list.size() * sizeof(Type));
      else
        for (Type &value : list)
          one(value);
    }
    template <typename List>
    void
    resize(List &list, const std::size_t min_bytes)
    {
      std::size_t n = list.size();
      raw(&n, sizeof(n));
      if (reads_ && n > (bytes_.size() - place_) / min_bytes)
        fail("a list");
      list.resize(n);
    }

    void
    raw(void *data, std::size_t n);
    [[noreturn]] static void
    fail(std::string_view what);

    std::string bytes_;
    std::size_t place_ = 0;
    bool reads_        = false;
  };

  /// The bytes of @p value.
  template <typename Type>
  std::string
  archived(Type &value)
  {
    Archive archive;
    archive(value);
    return archive.bytes();
  }
} // namespace crawler
