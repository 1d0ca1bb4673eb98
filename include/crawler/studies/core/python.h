// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/log.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace crawler
{
  /// Exception: a signal has stopped a part of the program that is written in Python.
  class Stopped : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// End of a part of the program that is written in Python.
  struct PythonEnd
  {
    int status;          ///< 0, that of the script, or EX_UNAVAILABLE if no Python has the modules it needs
    std::string problem; ///< error message, in one line
  };

  /// Calls a @p script of contrib/python/crawler ("plot/sweep.py"), also of an installed program, with the python3 of
  /// the PATH or, if there is none, Debian's. Its output is shown if @p shown.
  PythonEnd
  call_python(const std::string &script, const std::vector<std::string> &arguments, bool shown);

  /// Calls a script with its output shown; throws InputError, FileError and Stopped with the message of the script.
  void
  hand_over_to_python(const std::string &script, const std::vector<std::string> &arguments);

  /// Draws the picture of a study's @p folder with plot/KIND.py, or logs why there is none.
  void
  draw(const std::string &kind, const std::filesystem::path &folder, Log &log);
} // namespace crawler
