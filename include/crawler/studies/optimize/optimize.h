// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/parameters/parameter_file.h>
#include <crawler/studies/core/command_options.h>
#include <crawler/studies/core/log.h>

#include <mpi.h>

namespace crawler
{
  /**
   * crawler optimize: the best gait of section Optimize (collective). Ranks share the starts; each ends as a row of
   * starts.h5, so that a study that was killed can be resumed with --resume. Then the best gait is written as
   * optimum.prm and run with all files, into the folder "best".
   */
  ExitCode
  optimize(MPI_Comm communicator, const CommandOptions &options, const ParameterFile &file);

  /// Computes the start of each case and reports its numbers, for `crawler check`. Returns false if the file varies
  /// nothing. Throws InputError.
  bool
  check_optimize(MPI_Comm communicator, const ParameterFile &file, Log &log);
} // namespace crawler
