// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace crawler
{
  /// The admissible values of a number: an interval possibly without ends.
  struct Range
  {
    double lower        = -std::numeric_limits<double>::infinity();
    double upper        = std::numeric_limits<double>::infinity();
    bool lower_included = false;
    bool upper_included = false;

    bool
    contains(double value) const;
    std::string
    in_words() const;
  };

  constexpr Range
  any_number()
  {
    return {};
  }
  constexpr Range
  positive()
  {
    return {.lower = 0.};
  }
  constexpr Range
  not_negative()
  {
    return {.lower = 0., .lower_included = true};
  }
  constexpr Range
  between(const double lower, const double upper)
  {
    return {lower, upper, true, true};
  }

  enum class EntryKind
  {
    text,
    number,
    whole_number,
    numbers,   ///< a list; "Section/Entry[2]" is the second of them
    constants, ///< of formulas, name=number, ...; "Section/Entry[a]" is the number of a
    profile,   ///< a formula, a list as above, or the name of a file
    choice,
    flag
  };

  /// Admissible values of an entry, for other programs.
  struct EntryValues
  {
    EntryKind kind                 = EntryKind::text;
    Range range                    = {};    ///< of a number
    std::vector<std::string> words = {};    ///< of a choice; of constants, the entries with formulas that may use them
    bool may_be_automatic          = false; ///< the word "automatic" is admissible
    bool may_be_empty              = false; ///< of a list
    bool one_is_all                = false; ///< a list with numbers of all parts, or one for all
  };

  /// Description of one entry of the parameter file for the user.
  struct EntryInfo
  {
    std::string path; ///< "Section/Subsection/Entry"
    std::string default_value;
    std::string expected;           ///< the admissible values in words
    std::string unit          = ""; ///< empty for words and counts
    std::string documentation = "";
    bool names_file           = false; ///< the value names a file to be read, or may do so
    bool names_several        = false; ///< files, separated by semicolons
    std::string file_ending   = "";    ///< if not empty, only values with this ending name files
    EntryValues values        = {};
  };
} // namespace crawler
