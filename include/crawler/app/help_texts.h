// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace crawler
{
  /// Command line with its purpose.
  struct Example
  {
    std::string command, meaning;
  };

  /// Examples of a command; without a name, first steps.
  std::vector<Example>
  examples_of(const std::string &command = "");

  /// Kinds of pictures of contrib/python/crawler/pictures.py.
  const std::vector<std::string> &
  plot_kinds();

  /// Exit code with its meaning.
  struct ExitCodeMeaning
  {
    std::string code, meaning;
  };

  /// Exit codes as in the table of the user guide.
  std::vector<ExitCodeMeaning>
  exit_code_meanings();

  /// Commands of the program, in the order of the help.
  std::vector<const CLI::App *>
  all_commands(const CLI::App &app);

  /// Names of an option as they are typed: "--set", "-h".
  std::vector<std::string>
  typed_names(const CLI::Option &option);

  /// Text at the end of crawler --help.
  std::string
  help_footer();

  /// Text at the end of crawler COMMAND --help.
  std::string
  help_footer(const std::string &command);
} // namespace crawler
