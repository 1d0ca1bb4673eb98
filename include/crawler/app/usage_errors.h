// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>
#include <vector>

namespace crawler
{
  /// Throws InputError unless the first argument is a command or an option.
  void
  require_command(const CLI::App &app, const std::vector<std::string> &arguments);

  /// Describes the error in the arguments in a sentence, with more detail than CLI11.
  std::string
  usage_error(const CLI::ParseError &error, const CLI::App &app, const std::vector<std::string> &arguments);
} // namespace crawler
