// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace crawler
{
  /// Kinds of pictures of contrib/python/crawler/pictures.py.
  const std::vector<std::string> &
  plot_kinds();

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

  /// crawler man: prints the manual page, for man(1).
  void
  print_manual(const CLI::App &app);
} // namespace crawler
