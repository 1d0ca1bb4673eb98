// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// Templates of crawler init: "robot", "earthworm", ...
  std::vector<std::string>
  template_names();

  /// crawler init: prints the template of this name, or writes it to the new file @p output if this is not empty.
  /// Throws InputError if there is no such template or the file exists already, and FileError.
  void
  print_template(const std::string &name, const std::string &output);
} // namespace crawler
