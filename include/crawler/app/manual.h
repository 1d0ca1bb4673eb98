// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace crawler
{
  /// crawler man: prints the manual page, for man(1).
  void
  print_manual(const CLI::App &app);
} // namespace crawler
