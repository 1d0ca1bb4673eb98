// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <string>
#include <vector>

namespace crawler
{
  /// Command line without the name of the command.
  struct CommandOptions
  {
    std::string file;
    std::vector<std::string> overrides;
    std::string output;
    bool overwrite      = false;
    bool resume         = false;
    bool strict         = false;
    bool quiet          = false;
    bool check_gradient = false;
    std::string command_line;
    std::string petsc_options; ///< behind "--"
  };
} // namespace crawler
