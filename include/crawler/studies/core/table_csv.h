// SPDX-License-Identifier: LGPL-2.1-or-later
#pragma once

#include <crawler/base/table.h>

#include <mpi.h>

#include <filesystem>
#include <functional>
#include <string>

namespace crawler
{
  /// Writes the table of a RowFile as comma-separated values, in parts of some rows each, which the ranks share
  /// (collective); each rank sees its own parts. Throws FileError, on all ranks.
  void
  write_table_csv(MPI_Comm communicator,
                  const std::filesystem::path &table,
                  const std::string &group,
                  const std::filesystem::path &csv,
                  const std::function<void(const Table &part)> &see);
} // namespace crawler
