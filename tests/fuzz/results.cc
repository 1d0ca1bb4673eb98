// SPDX-License-Identifier: LGPL-2.1-or-later
//
// results.h5 of a study that is resumed: what is changed in a whole one.
#include <crawler/base/files.h>
#include <crawler/base/row_file.h>

#include <fstream>

#include "fuzz.h"

namespace
{
  using namespace crawler;

  const std::vector<RowFile::Column> columns = {{"Body/Length", "length", "axis of the sweep", 0},
                                                {"displacement", "length", "of the centre of mass", 0},
                                                {"status", "", "of the run", 8}};

  std::string
  whole_table()
  {
    const std::filesystem::path path = fuzz::scratch() / "whole.h5";
    RowFile::create(path,
                    "results",
                    columns,
                    4,
                    {{"parameters.prm", "set Model = linear"}},
                    {1, [](std::size_t, const unsigned long row) { return RowFile::Value(1. * row); }});
    {
      RowFile file(MPI_COMM_SELF, path, "results", {columns.begin() + 1, columns.end()});
      file.write(0, std::vector<RowFile::Row>{{0.25, "finished"}, {0.5, "failed"}});
    }
    return read_whole_file(path);
  }
} // namespace

int
LLVMFuzzerTestOneInput(const std::uint8_t *data, const std::size_t size)
{
  fuzz::start_mpi();
  static const std::string whole = whole_table();
  fuzz::Bytes bytes(data, size);
  const std::filesystem::path path = fuzz::scratch() / "results.h5";
  std::ofstream(path, std::ios::binary) << fuzz::damaged(whole, bytes);
  fuzz::is_accepted([&]() {
    read_attribute(path, "results", "parameters.prm");
    const RowReader table(MPI_COMM_SELF, path, "results");
    const unsigned long n = std::min(table.n_rows(), 100ul);
    table.intact({columns.begin() + 1, columns.end()}, 0, n);
    csv(table.read(0, n));
  });
  return 0;
}
