// SPDX-License-Identifier: LGPL-2.1-or-later
//
// Parts of the Python package that need libraries which the wheel does not have, besides those of
// contrib/one_process/left_out.cc: commands with their files, tables in HDF5. MPI and PETSc have nothing to start.
#include "../python/command.h"

#include <crawler/base/grid_table.h>
#include <crawler/base/mpi_session.h>
#include <crawler/base/versions.h>

namespace crawler
{
  MpiSession::MpiSession(int &, char **&)
  {
  }
  MpiSession::~MpiSession() = default;

  std::map<std::string, std::string>
  versions()
  {
    return {{"crawler", CRAWLER_VERSION}, {"revision", CRAWLER_REVISION}};
  }

  std::pair<int, std::vector<std::string>>
  run_command(const std::string &name, const CommandOptions &, const ParameterFile &)
  {
    throw InputError(
      (name == "optimize" ? "crawler.optimize needs Trilinos" : "files of crawler." + name + " need HDF5 and PETSc") +
      ", " CRAWLER_LEFT_OUT);
  }

  GridTable
  read_hdf5_grid_table(const GridTableSource &source)
  {
    source.refuse("\"{}\" is read by HDF5, " CRAWLER_LEFT_OUT "; a CSV file is read here, too", source.file);
  }
} // namespace crawler
