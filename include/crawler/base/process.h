// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// How another program ended.
  struct ProgramEnd
  {
    bool started = false;
    int status   = -1;  ///< that of its end; -1: a signal ended it, or it did not start
    std::string errors; ///< what it wrote to its standard error
  };

  /// Runs another program, which is looked for in the PATH, without input, and waits for its end. What it writes to its
  /// standard output is shown if @p shown.
  ProgramEnd
  run_program(const std::vector<std::string> &command, bool shown);
} // namespace crawler
