// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/exceptions.h>
#include <crawler/studies/table/measured_table.h>

#include <CLI/CLI.hpp>
#include <mpi.h>

namespace crawler
{
  /// crawler table: its options on the command line.
  class TableCommand
  {
  public:
    explicit TableCommand(CLI::App &app);
    TableCommand(const TableCommand &) = delete;

    bool
    is(const CLI::App *chosen) const
    {
      return chosen == command_;
    }

    /// Runs it on the first rank. Throws InputError and FileError.
    ExitCode
    operator()(MPI_Comm communicator) const;

  private:
    CLI::App *command_;
    TableOptions options_;
  };
} // namespace crawler
