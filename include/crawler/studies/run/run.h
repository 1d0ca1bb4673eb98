// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/core/command_options.h>

#include <mpi.h>

#include <filesystem>
#include <string>
#include <vector>

namespace crawler
{
  /// crawler run: one simulation with all its files (collective).
  ExitCode
  run(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file);

  /// Run of @p file for a study with these @p options, with all files in the folder @p place, which is made (this rank
  /// alone).
  ExitCode
  run_for_study(CommandOptions options,
                const std::filesystem::path &file,
                const std::vector<std::string> &overrides,
                const std::filesystem::path &place);
} // namespace crawler
