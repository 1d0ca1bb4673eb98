// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/studies/core/log.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace crawler
{
  /// A signal has stopped a part of the program that is written in Python.
  class Stopped : public std::runtime_error
  {
  public:
    using std::runtime_error::runtime_error;
  };

  /// How a part of the program that is written in Python ended.
  struct PythonEnd
  {
    int status;          ///< 0, that of the script, or EX_UNAVAILABLE if no Python has what it needs
    std::string problem; ///< what is wrong, in one line
  };

  /// Calls a @p script of contrib/python/crawler ("plot/sweep.py"), also of an installed program, with the python3 of
  /// the PATH or, if there is none, Debian's. What it prints is shown if @p shown.
  PythonEnd
  call_python(const std::string &script, const std::vector<std::string> &arguments, bool shown);

  /// The same, shown; throws InputError, FileError and Stopped with what the script says.
  void
  hand_over_to_python(const std::string &script, const std::vector<std::string> &arguments);

  /// Draws the picture of a study's @p folder with plot/KIND.py, or says in the log why there is none.
  void
  draw(const std::string &kind, const std::filesystem::path &folder, Log &log);
} // namespace crawler
