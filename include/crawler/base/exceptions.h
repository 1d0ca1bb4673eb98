// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <fmt/format.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace crawler
{
  /// Exit codes of the process, a contract with users' scripts.
  enum class ExitCode
  {
    finished          = 0,
    bad_input         = 2,
    numerical_failure = 3,
    inverted          = 4,
    stopped           = 5,
    file_error        = 6,
    self_check_failed = 7,
    rows_failed       = 8 ///< of a sweep with --strict
  };

  /**
   * Wrong input of the user, in one sentence: what was found, what was expected, where to change it. `entry` is the
   * full name of the parameter at fault ("Body/Length"), empty if there is none; the reader of the file adds file and
   * line to the message when it knows them.
   */
  class InputError : public std::runtime_error
  {
  public:
    explicit InputError(const std::string &message, std::string entry = "")
      : std::runtime_error(message)
      , entry(std::move(entry))
    {
    }

    const std::string entry;
  };

  /// Throws InputError for @p entry, empty if there is none, with this sentence.
  template <typename... Arguments>
  [[noreturn]] void
  refuse(const std::string &entry, fmt::format_string<Arguments...> sentence, Arguments &&...arguments)
  {
    throw InputError(fmt::format(sentence, std::forward<Arguments>(arguments)...), entry);
  }
  /// Version that begins the sentence with the name of the entry.
  template <typename... Arguments>
  [[noreturn]] void
  refuse_entry(const std::string &entry, fmt::format_string<Arguments...> sentence, Arguments &&...arguments)
  {
    throw InputError("\"" + entry + "\": " + fmt::format(sentence, std::forward<Arguments>(arguments)...), entry);
  }

  /// Thrown by all ranks of a collective write if an active stress to be written is not a finite number.
  class NonfiniteStress : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// Thrown if a file or folder cannot be read or written.
  class FileError : public std::runtime_error
  {
  public:
    explicit FileError(const std::string &message, const bool on_all_ranks = false)
      : std::runtime_error(message)
      , on_all_ranks(on_all_ranks)
    {
    }

    const bool on_all_ranks; ///< thrown by all ranks together, so the program can end in order
  };
} // namespace crawler
