// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/words.h>
#include <crawler/parameters/entry_info.h>
#include <crawler/parameters/plain_text.h>

#include <filesystem>
#include <functional>
#include <iosfwd>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace crawler
{
  class EntryStore;

  /**
   * The list of all entries of the parameter file. A parameter struct declares its members here, each with its default,
   * range, unit and a sentence; from then on the member has the value of the entry:
   *
   *   declarations.number("Length", length, positive(), "length").means("Rest length L of the body.");
   *
   * Values are kept and printed by an EntryStore. Names are unique and have one spelling.
   */
  class Declarations
  {
  public:
    /// Restricts the list to @p only, the name of a section or an entry; other declarations are skipped.
    explicit Declarations(std::string only = "");
    ~Declarations();

    void
    enter(const std::string &section);
    void
    leave();

    /// A declared entry, which requires its explanation in one or more sentences.
    class [[nodiscard]] Entry
    {
    public:
      void
      means(const std::string &documentation);

    private:
      friend class Declarations;
      Declarations &owner_;
      std::string name_;
      EntryInfo info_;
      std::function<bool(const std::string &)> match_;
      std::function<void(const std::string &)> assign_;

      Entry(Declarations &owner, std::string name, EntryInfo info)
        : owner_(owner)
        , name_(std::move(name))
        , info_(std::move(info))
      {
      }
    };

    // Optional values also admit the word "automatic" (an empty optional).
    Entry
    number(const std::string &name, double &value, const Range &range, const std::string &unit);
    Entry
    number(const std::string &name, std::optional<double> &value, const Range &range, const std::string &unit);
    Entry
    whole_number(const std::string &name, unsigned int &value, unsigned int lower, unsigned int upper);
    Entry
    whole_number(const std::string &name, std::optional<unsigned int> &value, unsigned int lower, unsigned int upper);
    /// A list of numbers; it may be empty if the default is.
    Entry
    numbers(const std::string &name, std::vector<double> &value, const std::string &unit);
    Entry
    choice(const std::string &name, std::string &value, const std::vector<std::string> &words);
    /// A choice among the words of an enum (base/words.h).
    template <HasWords Enum>
    Entry
    choice(const std::string &name, Enum &value)
    {
      return choice(name, all_words<Enum>(), static_cast<std::size_t>(value), [&value](const std::size_t i) {
        value = static_cast<Enum>(i);
      });
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
    value(unsigned int index) const;

    /// Prints the present values as a .prm file with every entry explained.
    void
    print_prm(std::ostream &out) const;

  private:
    Entry
    choice(const std::string &name,
           const std::vector<std::string> &words,
           std::size_t value,
           const std::function<void(std::size_t)> &assign);
    template <typename Value, typename Read>
    Entry
    entry(const std::string &name,
          Value &value,
          const std::string &expected,
          const std::string &unit,
          EntryValues values,
          const Read &read);

    /// Finds a declared entry. Throws InputError with the nearest names if there is none.
    const EntryInfo &
    find(const std::vector<std::string> &path) const;
    [[noreturn]] void
    refuse_name(const std::vector<std::string> &words) const;

    std::string
    path_of(const std::string &name) const;

    const std::string only_;
    std::unique_ptr<EntryStore> store_;
    std::vector<std::string> section_; ///< section of the next declarations
    std::vector<EntryInfo> entries_;
    std::vector<std::string> sections_;
  };

  /// Splits a path into its words: "A/B/c" -> {"A", "B", "c"}, without blanks around them.
  std::vector<std::string>
  split_path(const std::string &path);

  /// The normal spelling of a path, for comparing entries: without blanks around its words.
  std::string
  normal_path(const std::string &path);
} // namespace crawler
