// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// What crawler init knows: "robot", "earthworm", ...
  std::vector<std::string>
  template_names();

  /// crawler init: prints the template of this name, or writes it to the new file @p output if this is not empty.
  /// Throws InputError if there is no such template, or if the file is there already, and FileError.
  void
  print_template(const std::string &name, const std::string &output);
} // namespace crawler
