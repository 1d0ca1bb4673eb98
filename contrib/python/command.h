// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/core/command_options.h>

#include <string>
#include <utility>
#include <vector>

namespace crawler
{
  /// `crawler run`, sweep or optimize with its files; the exit code, and notes. The wheel refuses it (contrib/wheel).
  std::pair<int, std::vector<std::string>>
  run_command(const std::string &name, const CommandOptions &options, const ParameterFile &file);
} // namespace crawler
