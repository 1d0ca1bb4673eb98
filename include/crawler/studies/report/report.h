// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/studies/core/command_options.h>

#include <mpi.h>

namespace crawler
{
  /**
   * `crawler report DIR`: makes the page DIR/report.html of what a command has left in the folder
   * (CommandOptions::file) so far. Nothing is computed, nothing else is changed (collective). Throws InputError if that
   * is no such folder or it is damaged, FileError if something cannot be read or written.
   */
  ExitCode
  report(MPI_Comm communicator, const CommandOptions &options);
} // namespace crawler
