// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>
#include <crawler/parameters/entry_info.h>
#include <crawler/parameters/plain_text.h>

#include <filesystem>
#include <functional>
#include <string>
#include <unordered_map>
#include <vector>

namespace crawler
{
  /**
   * The list of all entries of the parameter file. A parameter struct declares its members here, each with its default,
   * range, unit and a sentence; from then on the member has the value of the entry:
   *
   *   declarations.number("Length", length, positive(), "length").means("Rest length L of the body.");
   *
   * Names are unique and have one spelling.
   */
  class Declarations
  {
  public:
    /// Restricts the list to @p only, the name of a section or an entry; other declarations are skipped.
    explicit Declarations(std::string only = "");

    void
    enter(const std::string &section);
    void
    leave();

    /// Declares the entries of a parameter struct in a section; @p more are other arguments of its add_parameters().
    template <typename Struct, typename... More>
    void
    section(const std::string &name, Struct &parameters, const More &...more)
    {
      enter(name);
      parameters.add_parameters(*this, more...);
      leave();
    }

    /// Gives the member of an entry its value by a text; returns false and changes nothing if that is not admissible.
    using Take = std::function<bool(const std::string &text)>;

    /// A declared entry, which requires its explanation in one or more sentences.
    class [[nodiscard]] Entry
    {
    public:
      void
      means(const std::string &documentation);

    private:
      friend class Declarations;
      Declarations &owner_;
      EntryInfo info_;
      Take take_;

      Entry(Declarations &owner, EntryInfo info, Take take)
        : owner_(owner)
        , info_(std::move(info))
        , take_(std::move(take))
      {
      }
    };

    // Optional values also admit the word "automatic" (an empty optional).
    /// A double, or an optional one.
    template <typename Value>
    Entry
    number(const std::string &name, Value &value, const Range &range, const std::string &unit);
    /// An unsigned int, or an optional one.
    template <typename Value>
    Entry
    whole_number(const std::string &name, Value &value, unsigned int lower, unsigned int upper);
    /// A list of numbers; it may be empty if the default is. @p one_is_all: one for each part, or one for all.
    Entry
    numbers(const std::string &name, std::vector<double> &value, const std::string &unit, bool one_is_all = false);
    Entry
    choice(const std::string &name, std::string &value, const std::vector<std::string> &words);
    /// A choice among the words of an enum (base/words.h).
    template <HasWords Enum>
    Entry
    choice(const std::string &name, Enum &value)
    {
      return choice(
        name, word_of(value), all_words<Enum>(), [&value](const std::string &word) { value = *from_word<Enum>(word); });
    }
    Entry
    flag(const std::string &name, bool &value);
    Entry
    text(const std::string &name, std::string &value, const std::string &expected, const std::string &unit = "");
    /// Constants that the @p formulas of this section may use.
    Entry
    constants(const std::string &name, std::string &value, const std::vector<std::string> &formulas);
    /// A factor along the body: a formula of s, its values at equally spaced places, or the name of a CSV file.
    Entry
    profile(const std::string &name, std::string &value);
    /// A text that names a file; with @p ending, only if it ends so.
    Entry
    file(const std::string &name,
         std::string &value,
         const std::string &expected,
         const std::string &unit   = "",
         const std::string &ending = "");
    /// File names, separated by semicolons.
    Entry
    files(const std::string &name, std::string &value, const std::string &expected);

    /// Sets the entry with the full name @p path, or one number of it (listed_numbers.h), as "Section/Entry[2]". Throws
    /// InputError (naming the entry, the value found and the values expected, with the nearest names) if there is no
    /// such entry or the value does not fit. File names are relative to @p folder, and are kept and printed as absolute
    /// ones.
    void
    set(const std::string &path, const std::string &value, const std::filesystem::path &folder = "");

    /// The value that set() would keep: a file name as an absolute one.
    std::string
    with_absolute_name(const std::string &path, const std::string &value, const std::filesystem::path &folder) const;

    /// The present value of the entry @p path, or of one of its numbers. Throws InputError as set() does.
    std::string
    value(const std::string &path) const;

    /// The entry @p path; for one of its numbers, the whole entry.
    const EntryInfo &
    info(const std::string &path) const;

    /// Throws InputError with the nearest names unless @p path is a declared section.
    void
    require_section(const std::string &path) const;

    const std::vector<EntryInfo> &
    entries() const
    {
      return entries_;
    }

    /// The present value of the entry with number @p index of entries().
    std::string
    value(unsigned int index) const
    {
      return values_[index];
    }

  private:
    Entry
    choice(const std::string &name,
           const std::string &default_word,
           const std::vector<std::string> &words,
           const std::function<void(const std::string &word)> &assign);
    template <typename Value, typename Read>
    Entry
    entry(const std::string &name,
          Value &value,
          const std::string &expected,
          const std::string &unit,
          EntryValues values,
          const Read &read);

    /// Finds the number of a declared entry. Throws InputError with the nearest names if there is none.
    unsigned int
    find(const std::vector<std::string> &path) const;
    [[noreturn]] void
    refuse_name(const std::vector<std::string> &words) const;

    std::string
    path_of(const std::string &name) const;

    const std::string only_;
    std::vector<std::string> section_; ///< section of the next declarations
    std::vector<EntryInfo> entries_;
    std::vector<std::string> values_;                       ///< of the entries, as text
    std::vector<Take> takes_;                               ///< of the entries
    std::unordered_map<std::string, unsigned int> numbers_; ///< of the entries by their paths
    std::vector<std::string> sections_;
  };

  /// Splits a path into its words: "A/B/c" -> {"A", "B", "c"}, without blanks around them.
  std::vector<std::string>
  split_path(const std::string &path);

  /// Path of the section of an entry; empty at the top level.
  std::string
  section_of(const std::string &path);

  /// The normal spelling of a path, for comparing entries: without blanks around its words.
  std::string
  normal_path(const std::string &path);
} // namespace crawler
