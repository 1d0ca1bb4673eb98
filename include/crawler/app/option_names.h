// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace crawler
{
  /// Commands of the program, in the order of the help.
  std::vector<const CLI::App *>
  all_commands(const CLI::App &app);

  /// Names of an option as they are typed: "--set", "-h".
  std::vector<std::string>
  typed_names(const CLI::Option &option);
} // namespace crawler
