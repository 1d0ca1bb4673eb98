// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// A command line, and what it is for.
  struct Example
  {
    std::string command, meaning;
  };

  /// Those of a command; without a name, first steps.
  std::vector<Example>
  examples_of(const std::string &command = "");

  /// What a number that the program returns means.
  struct ExitCodeMeaning
  {
    std::string code, meaning;
  };

  /// The table of the user guide.
  std::vector<ExitCodeMeaning>
  exit_code_meanings();

  /// What stands at the end of crawler --help.
  std::string
  help_footer();

  /// What stands at the end of crawler COMMAND --help.
  std::string
  help_footer(const std::string &command);
} // namespace crawler
