// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>

#include <string>

namespace crawler
{
  /// crawler completion: prints a script by which @p shell completes commands, options, files and the names of entries.
  /// Throws InputError for another shell.
  void
  print_completion(const CLI::App &app, const std::string &shell);
} // namespace crawler
