// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// Values of --format: "prm", "json", ...
  std::vector<std::string>
  parameter_formats();

  /// crawler parameters: prints all entries, or those of a @p section (or one entry) if this is not empty, in a format.
  /// Throws InputError if there is no such section or format.
  void
  print_parameters(const std::string &format, const std::string &section);

  /// Full names of all entries.
  std::vector<std::string>
  entry_names();
} // namespace crawler
