// SPDX-License-Identifier: LGPL-2.1-or-later
#include <crawler/base/communication.h>
#include <crawler/base/exceptions.h>
#include <crawler/base/files.h>
#include <crawler/base/row_file.h>
#include <crawler/studies/core/table_csv.h>

#include <algorithm>
#include <fstream>

namespace crawler
{
  void
  write_table_csv(MPI_Comm communicator,
                  const std::filesystem::path &table_path,
                  const std::string &group,
                  const std::filesystem::path &csv,
                  const std::function<void(const Table &part)> &see)
  {
    constexpr unsigned long together = 256; // rows of each rank, a quarter of a megabyte
    const RowReader table(communicator, table_path, group);
    const unsigned long n_ranks = size_of(communicator), rank = rank_of(communicator);
    std::ofstream file;
    std::filesystem::path temporary;
    on_first_rank(communicator, [&]() {
      temporary = temporary_file(csv);
      file.open(temporary);
      file << csv_names(table.read(0, 0));
    });
    for (unsigned long round = 0; round < table.n_rows(); round += n_ranks * together)
    {
      const unsigned long first = std::min(round + rank * together, table.n_rows());
      const Table part          = table.read(first, std::min(together, table.n_rows() - first));
      for (const std::string &rows : gather(csv_rows(part), communicator))
        file << rows;
      see(part);
    }
    on_first_rank(communicator, [&]() {
      file.close();
      if (!file)
      {
        std::error_code error;
        std::filesystem::remove(temporary, error);
        throw FileError("cannot write \"" + csv.string() + "\" (is the disk full?)");
      }
      rename_whole(temporary, csv);
    });
  }
} // namespace crawler
