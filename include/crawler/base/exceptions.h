// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <stdexcept>
#include <string>

namespace crawler
{
  /// What the process returns to the shell. These numbers are a contract with users' scripts.
  enum class ExitCode
  {
    finished          = 0,
    bad_input         = 2,
    numerical_failure = 3,
    inverted          = 4,
    stopped           = 5,
    file_error        = 6,
    self_check_failed = 7
  };

  /**
   * The user's input is wrong. One sentence: what was found, what was expected, where to change it.
   * `entry` is the full name of the parameter at fault ("Body/Length"), empty if there is none; the
   * reader of the file adds file and line to the message when it knows them.
   */
  class InputError : public std::runtime_error
  {
  public:
    explicit InputError(const std::string &message, std::string entry = "")
      : std::runtime_error(message)
      , entry(std::move(entry))
    {}

    const std::string entry;
  };

  /// A file or folder cannot be read or written.
  class FileError : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /**
   * A time step could not be completed, or its result must not be used. `reason` is one of the names
   * of doc/user_guide.md (newton_diverged, linear_failed, step_underflow, rejection_limit, nonfinite,
   * under_resolved, inverted).
   */
  class NumericalFailure : public std::runtime_error
  {
  public:
    NumericalFailure(std::string reason, const std::string &message)
      : std::runtime_error(message)
      , reason(std::move(reason))
    {}

    const std::string reason;
  };
} // namespace crawler
